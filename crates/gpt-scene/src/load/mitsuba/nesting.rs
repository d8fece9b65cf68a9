//! How deep a file's elements lie within each other.

use crate::load::error::SceneError;

/// Most elements within each other. Scenes have about ten.
pub const DEEPEST: usize = 100;

/// Elements that lie too deep within each other would take the parser's stack.
pub fn check_depth(name: &str, text: &str) -> Result<(), SceneError> {
    let bytes = text.as_bytes();
    let mut depth = 0_usize;
    let mut rest = 0;
    while let Some(found) = text[rest..].find('<') {
        let at = rest + found;
        let (step, skip) = match bytes.get(at + 1) {
            Some(b'!') if text[at..].starts_with("<!--") => (0, text[at..].find("-->").unwrap_or(1)),
            Some(b'/') => (-1, 2),
            Some(b'!' | b'?') | None => (0, 1),
            Some(_) => {
                let end = text[at..].find('>').unwrap_or(1);
                (if end > 0 && bytes[at + end - 1] == b'/' { 0 } else { 1 }, end.max(1))
            }
        };
        depth = depth.saturating_add_signed(step);
        if depth > DEEPEST {
            let line = text[..at].matches('\n').count() + 1;
            return Err(SceneError::in_line(name, line, format!("elements lie more than {DEEPEST} deep within each other")));
        }
        rest = at + skip;
        while !text.is_char_boundary(rest) {
            rest += 1;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deep_files_are_refused_before_they_are_parsed() {
        let deep = format!("<scene>{}", "<a>".repeat(1_000_000));
        assert!(check_depth("a.xml", &deep).is_err());
        assert!(check_depth("a.xml", &"<a><b/></a><!-- <c> -->".repeat(1000)).is_ok());
    }
}
