"""Tables in documents: between <!-- NAME --> and <!-- /NAME -->, or the whole of a file that is not there yet."""


def write(path, name, text):
    begin, end = f"<!-- {name} -->\n", f"<!-- /{name} -->"
    if not path.exists():
        path.write_text(text)
        return
    document = path.read_text()
    if begin not in document or end not in document:
        raise SystemExit(f"{path} has no lines {begin.strip()} and {end} to write between")
    head, rest = document.split(begin, 1)
    path.write_text(head + begin + text + end + rest.split(end, 1)[1])
