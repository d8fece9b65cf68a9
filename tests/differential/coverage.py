"""Whether the scenes hold everything that the importer of Mitsuba's XML has a word for.

The importer's words are the names in its source: of elements, plugins, parameters and their values. What it writes, the keys of gpt's own scene
files, is told apart by the calls that write and read those. Each word has to occur in a scene, or in `known.NOT_IN_SCENES` with the reason why
no scene can hold it. So a plugin or a parameter that the importer learns to read cannot be forgotten here."""

import re

from programs import ROOT

IMPORTER = ROOT / "crates" / "gpt-scene" / "src" / "load" / "mitsuba"
# Calls whose first argument is a key of gpt's own scene files.
_OWN_KEYS = r"(?:with|with_some|set|of_type|keys\.get|keys\.text|entry\.keys\.get|\bget|child_key)\(\s*$"
_WORD = re.compile(r'"([A-Za-z][A-Za-z0-9_.\-]*)"')


def words():
    """(word, file) of all of them."""
    found = {}
    for file in sorted(file for file in IMPORTER.rglob("*.rs") if file.name != "tests.rs"):
        text = file.read_text().split("#[cfg(test)]")[0]
        text = re.sub(r"//[^\n]*", "", text)
        for match in _WORD.finditer(text):
            before = text[max(0, match.start() - 40) : match.start()]
            if not re.search(_OWN_KEYS, before):
                found.setdefault(match.group(1), file.relative_to(ROOT))
    return found


def words_of_scenes(texts):
    """Names and words of values, as they are written and as the importer brings them up to date."""
    found = set()
    for text in texts:
        found.update(word.lower() for word in re.findall(r"<([A-Za-z]+)", text) + re.findall(r'([A-Za-z]+)="', text))
        for value in re.findall(r'"([^"]*)"', text):
            found.add(value.lower())
            found.update(word.lower() for word in re.findall(r"[A-Za-z][A-Za-z0-9_\-]*", value))
    return found
