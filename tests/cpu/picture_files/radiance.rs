//! Radiance's pictures.

use super::{expect, expect_named, read, refusal};

const SIZE: [usize; 2] = [3, 2];

/// Mantissas and exponent of a pixel, no two alike.
fn code(column: usize, row: usize) -> [u8; 4] {
    [128 + 10 * column as u8, 64 + 20 * row as u8, (7 * (column + 3 * row)) as u8, 127 + (column + row) as u8]
}

fn value(column: usize, row: usize) -> [f32; 3] {
    let [red, green, blue, exponent] = code(column, row);
    [red, green, blue].map(|mantissa| f32::from(mantissa) * 2.0_f32.powi(i32::from(exponent) - 136))
}

/// A file with this header, whose pixels stand in the order of `places`.
fn file(header: &str, places: &[[usize; 2]]) -> Vec<u8> {
    let mut bytes = header.as_bytes().to_vec();
    bytes.extend(places.iter().flat_map(|[column, row]| code(*column, *row)));
    bytes
}

/// From the left, then from the top.
fn usual() -> Vec<[usize; 2]> {
    (0..SIZE[1]).flat_map(|row| (0..SIZE[0]).map(move |column| [column, row])).collect()
}

#[test]
fn the_eight_orientations_show_one_picture() {
    let [columns, rows] = SIZE;
    for (first, is_column_first) in [("Y", false), ("X", true)] {
        for (x, y) in [("+", "-"), ("-", "-"), ("+", "+"), ("-", "+")] {
            // Coordinates of Radiance go from the left to the right, and from below upwards.
            let column = |place: usize| if x == "+" { place } else { columns - 1 - place };
            let row = |place: usize| if y == "-" { place } else { rows - 1 - place };
            let places: Vec<[usize; 2]> = if is_column_first {
                (0..columns).flat_map(|a| (0..rows).map(move |b| (a, b))).map(|(a, b)| [column(a), row(b)]).collect()
            } else {
                (0..rows).flat_map(|b| (0..columns).map(move |a| (a, b))).map(|(a, b)| [column(a), row(b)]).collect()
            };
            let line =
                if is_column_first { format!("{x}X {columns} {y}Y {rows}") } else { format!("{y}Y {rows} {x}X {columns}") };
            let picture = read("a.hdr", &file(&format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{line}\n"), &places));
            expect(&picture, [3, 2], 0.0, value);
            assert!(picture.notes.is_empty(), "{first} {line}: {:?}", picture.notes);
        }
    }
}

#[test]
fn exposures_are_divided_out_whatever_ends_the_lines() {
    for end in ["\n", "\r\n"] {
        let lines =
            ["#?RADIANCE", "FORMAT=32-bit_rle_rgbe", "EXPOSURE=2.0", "COLORCORR= 1 2 4", "EXPOSURE= 4", "", "-Y 2 +X 3", ""];
        let picture = read("a.hdr", &file(&lines.join(end), &usual()));
        expect(&picture, [3, 2], 1e-6, |column, row| {
            let [red, green, blue] = value(column, row);
            [red / 8.0, green / 16.0, blue / 32.0]
        });
        assert!(picture.notes.is_empty(), "{:?}", picture.notes);
    }
    // Without a format, under another program's name, and by another ending.
    for (name, header) in [("a.hdr", "#?RGBE\n\n-Y 2 +X 3\n"), ("a.pic", "#?AnyTool\nmade by hand\n\n-Y 2 +X 3\n")] {
        expect(&read(name, &file(header, &usual())), [3, 2], 0.0, value);
    }
}

#[test]
fn runs_of_both_kinds_are_read() {
    // Old runs repeat the pixel before; new ones have the components one after the other.
    let mut old = b"#?RADIANCE\n\n-Y 2 +X 4\n".to_vec();
    for row in 0..2 {
        old.extend(code(0, row));
        old.extend([1, 1, 1, 2]);
        old.extend(code(1, row));
    }
    let picture = read("old.hdr", &old);
    expect(&picture, [4, 2], 0.0, |column, row| value(usize::from(column == 3), row));
    let mut new = b"#?RADIANCE\n\n-Y 1 +X 9\n".to_vec();
    new.extend([2, 2, 0, 9]);
    for component in 0..4 {
        new.extend([128 + 5, code(1, 0)[component], 4]);
        new.extend([0; 4].map(|_| code(2, 1)[component]));
    }
    let picture = read("new.hdr", &new);
    expect(&picture, [9, 1], 0.0, |column, _| if column < 5 { value(1, 0) } else { value(2, 1) });
}

#[test]
fn other_colours_become_rec_709() {
    // X, Y and Z in lm/sr/m², of which Radiance makes radiance by 179 lm/W; equal ones are its white.
    let header = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n";
    let grey = [header.as_bytes(), &[128, 128, 128, 136]].concat();
    expect(&read("a.hdr", &grey), [1, 1], 1e-3, |_, _| [128.0 / 179.0; 3]);
    // Red of Rec. 2020 is redder than any of Rec. 709 (ITU-R BT.2087).
    let header = "#?RADIANCE\nPRIMARIES= .708 .292 .17 .797 .131 .046 .3127 .329\n\n-Y 1 +X 1\n";
    let red = [header.as_bytes(), &[128, 0, 0, 129]].concat();
    expect(&read("a.hdr", &red), [1, 1], 1e-3, |_, _| [1.6605, -0.1246, -0.0182]);
}

#[test]
fn what_is_not_used_is_named() {
    for (line, word) in [("PIXASPECT=2", "PIXASPECT"), ("GAMMA=2.2", "GAMMA"), ("EXPOSURE=-1", "EXPOSURE")] {
        let bytes = file(&format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n{line}\n\n-Y 2 +X 3\n"), &usual());
        expect_named("a.hdr", &bytes, word);
    }
    let spectral = refusal("a.hdr", b"#?RADIANCE\nFORMAT=Spectral\n\n-Y 1 +X 1\n");
    assert!(spectral.contains("Spectral"), "{spectral}");
}
