//! One page, in one file, that shows two pictures and where they differ: `gpt test` and `gpt compare --html` write it.
//!
//! The page holds the pictures' values in half precision and develops them itself, so that exposure can be changed and values be read.

mod data;
mod section;

use maud::{DOCTYPE, Markup, PreEscaped, html};

pub use section::{PicturePair, Section, Tone};

/// Pixels of all pictures of a page together, of which there are two each; beyond that, pictures are left out.
const MOST_PIXELS: u64 = 24 << 20;

/// Findings that are listed; the map shows all.
const MOST_FINDINGS: usize = 24;

/// The whole page. `command` is what was typed, `method` how the verdict came about.
pub fn page(title: &str, command: &str, method: &str, sections: &[Section]) -> String {
    let mut pixels_left = MOST_PIXELS;
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(include_str!("page.css"))) }
            }
            body {
                h1 { (title) }
                p { code { (command) } " · gpt " (env!("CARGO_PKG_VERSION")) }
                p { (method) }
                @if sections.len() > 1 { (contents(sections)) }
                @for (number, section) in sections.iter().enumerate() { (of_section(number, section, &mut pixels_left)) }
                script { (PreEscaped(include_str!("page.js"))) }
            }
        }
    }
    .into_string()
}

fn contents(sections: &[Section]) -> Markup {
    html! {
        ul class="contents" {
            @for (number, section) in sections.iter().enumerate() {
                li { a href=(format!("#s{number}")) { (section.title) } " " (verdict(section)) }
            }
        }
    }
}

fn verdict(section: &Section) -> Markup {
    let class = match section.tone {
        Tone::Green => "green",
        Tone::Red => "red",
        Tone::Grey => "grey",
    };
    html! { span class=(class) { (section.verdict) } }
}

fn of_section(number: usize, section: &Section, pixels_left: &mut u64) -> Markup {
    let data = section.shown.as_ref().and_then(|shown| {
        let pixels = shown.images[0].pixels.len() as u64;
        let fits = pixels <= *pixels_left;
        if fits {
            *pixels_left -= pixels;
        }
        fits.then(|| data::json(shown))
    });
    html! {
        section id=(format!("s{number}")) {
            h2 { (section.title) " " (verdict(section)) }
            ul { @for fact in &section.facts { li { (fact) } } }
            @match (&data, &section.shown) {
                (Some(data), Some(shown)) => (viewer(data, shown.labels)),
                (None, Some(_)) => p { "The pictures are too large for this page; the commands below show them one by one." },
                (_, None) => {}
            }
            @if !section.findings.is_empty() { (findings(section)) }
            @for command in &section.commands { pre { (command) } }
        }
    }
}

fn viewer(data: &str, [first, second]: [&str; 2]) -> Markup {
    let mode = |key: &str, label: &str, title: &str| html! { button type="button" data-mode=(key) title=(title) { (label) } };
    html! {
        div class="viewer" {
            div class="tools" {
                (mode("a", first, "Key 1"))
                (mode("b", second, "Key 2"))
                (mode("flip", "switch", "Both in turn, half a second each (key 3)"))
                (mode("difference", "difference", "Grey where equal; brighter is more, and darker less (key 4)"))
                (mode("z", "z-map", "Standard errors of each tile's difference: red is more, blue is less (key 5)"))
                (mode("eye", "ꟻLIP", "What the eye sees (key 6)"))
                label { "exposure " input type="range" class="exposure" min="-8" max="8" step="0.25" value="0"; output { "0 EV" } }
                label { "zoom " input type="range" class="zoom" min="0" max="4" step="1" value="0"; }
            }
            div class="scroller" { canvas tabindex="0" aria-label=(format!("{first} and {second}")) {} }
            p class="readout" { "Point at a pixel for its values." }
            noscript { p { "The pictures need JavaScript; all of it is in this file." } }
            script type="application/json" { (PreEscaped(data)) }
        }
    }
}

fn findings(section: &Section) -> Markup {
    html! {
        ol class="findings" {
            @for (region, sentence) in section.findings.iter().take(MOST_FINDINGS) {
                li data-region=(format!("{},{},{},{}", region.x, region.y, region.width, region.height)) { (sentence) }
            }
        }
        @if section.findings.len() > MOST_FINDINGS { p { "and " (section.findings.len() - MOST_FINDINGS) " more" } }
    }
}

#[cfg(test)]
mod tests;
