// Two pictures of the page, one over the other; the range says where one ends. Without this script the pictures below still show.
for (const slider of document.querySelectorAll(".slider")) {
  const [left, right] = slider.querySelectorAll("select");
  const [under, over] = slider.querySelectorAll("img");
  const range = slider.querySelector("input");
  const show = () => {
    under.src = document.getElementById(left.value).src;
    over.src = document.getElementById(right.value).src;
    over.style.clipPath = `inset(0 0 0 ${range.value}%)`;
  };
  for (const control of [left, right, range]) control.addEventListener("input", show);
  slider.hidden = false;
  show();
}
