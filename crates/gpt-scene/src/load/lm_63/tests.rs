use super::*;

const OFFICE: &str = "IESNA:LM-63-2002
[TEST] 1
[MANUFAC] nobody
TILT=NONE
1 -1 2.0 3 2 1 2 0.1 0.2 0
0.5 9 20
0 45 90
0 90
10 20
30 40 50
60
";

fn profile(text: &str) -> LightProfile {
    match read(text.as_bytes()) {
        Ok(photometry) => photometry.profile,
        Err(Mistake { line, message }) => panic!("line {line}: {message}"),
    }
}

fn fault(text: &str) -> (usize, String) {
    let Mistake { line, message } = read(text.as_bytes()).expect_err("it is wrong");
    (line, message)
}

#[test]
fn numbers_may_stand_in_any_lines() {
    let read = profile(OFFICE);
    assert_eq!(read.vertical(), [0.0, 45.0, 90.0]);
    assert_eq!(read.horizontal(), [0.0, 90.0, 180.0, 270.0, 360.0]);
    // The factor 2 times the ballast's ½; the number behind is for future use in 2002.
    assert_eq!(read.candela()[..6], [10.0, 20.0, 30.0, 40.0, 50.0, 60.0]);
    for other in [
        OFFICE.replace('\n', "\r\n"),
        OFFICE.replace('\n', "\r"),
        OFFICE.replace("0 45 90", "0,45, 90").replace("TILT=NONE", " tilt = none "),
        format!("\u{feff}{OFFICE}"),
    ] {
        assert_eq!(profile(&other), read);
    }
    let latin = [&b"IESNA:LM-63-2002\n[LUMINAIRE] caf\xe9\n"[..], &OFFICE.as_bytes()[OFFICE.find("TILT").unwrap()..]].concat();
    assert_eq!(super::read(&latin).unwrap().profile, read);
}

/// Up to 1995 the number behind the ballast factor is a factor as well; later it is not.
#[test]
fn the_standard_says_what_the_factors_are() {
    for (first_line, factor) in [
        ("IESNA:LM-63-2002", 1.0),
        ("IES:LM-63-2019", 1.0),
        ("IESNA:LM-63-1995", 9.0),
        ("IESNA91", 9.0),
        ("A lamp of 1986", 9.0),
        ("IES", 9.0),
    ] {
        assert_eq!(profile(&OFFICE.replace("IESNA:LM-63-2002", first_line)).candela()[0], 10.0 * factor, "{first_line}");
    }
}

#[test]
fn tilt_is_read_past_and_said() {
    let with = |tilt: &str| read(OFFICE.replace("TILT=NONE", tilt).as_bytes()).expect("it is possible");
    let plain = with("TILT=NONE");
    assert!(plain.notes.is_empty());
    let even = with("TILT=INCLUDE\n1\n3\n0 45 90\n1 1 1");
    assert_eq!((&even.profile, even.notes.len()), (&plain.profile, 0));
    let uneven = with("TILT=INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8");
    assert_eq!(uneven.profile, plain.profile);
    assert!(uneven.notes[0].message.contains("tilt") && uneven.notes[0].line == 4, "{:?}", uneven.notes);
    let elsewhere = with("TILT=lamp.tlt");
    assert!(elsewhere.notes[0].message.contains("`lamp.tlt`"), "{:?}", elsewhere.notes);
    let longer = read(format!("{OFFICE}7 8\n").as_bytes()).unwrap();
    assert!(longer.notes[0].message.contains("2 words more") && longer.notes[0].line == 12, "{:?}", longer.notes);
}

#[test]
fn what_is_written_is_read_again() {
    let read = profile(&OFFICE.replace("10 20", "0.1 1e-3"));
    assert_eq!(profile(&written(&read)), read);
    assert_ne!(profile(&written(&read)), profile(OFFICE), "the control");
}

#[test]
fn mistakes_have_their_line() {
    for (from, to, line, words) in [
        ("TILT=NONE", "", 12, "no line `TILT"),
        ("1 -1 2.0", "1 -1 zero", 5, "expected the factor of candela, found `zero`"),
        ("1 -1 2.0", "1 -1 0", 5, "must be above 0"),
        ("2.0 3 2 1", "2.0 3.5 2 1", 5, "vertical angles is 3.5"),
        ("2.0 3 2 1", "2.0 3000000000 2 1", 5, "vertical angles is 3000000000"),
        ("2.0 3 2 1", "2.0 4000 4000 1", 6, "expected 4000 numbers, one for each vertical angle"),
        ("2.0 3 2 1", "2.0 3 2 2", 5, "type B"),
        ("2.0 3 2 1", "2.0 3 2 3", 5, "type A"),
        ("2.0 3 2 1", "2.0 3 2 7", 5, "photometry is 7"),
        ("0 45 90\n", "0 95 90\n", 7, "ascend"),
        ("0 90\n", "0 80\n", 8, "0 alone"),
        ("30 40 50", "30 -40 50", 10, "-40 candela"),
        ("30 40 50", "30 inf 50", 10, "found `inf`"),
        ("30 40 50\n60\n", "30", 8, "the file ends after 3"),
    ] {
        assert!(OFFICE.contains(from), "{from}");
        let found = fault(&OFFICE.replacen(from, to, 1));
        assert!(found.0 == line && found.1.contains(words), "{from} → {to}: {found:?}");
    }
    assert_eq!(fault("").0, 1);
    assert!(fault("PNG\0\0\0").1.contains("no photometric file"));
}

/// Files cut anywhere, and with bytes changed anywhere, are read or refused.
#[test]
fn no_file_brings_the_reader_down() {
    let tilted = OFFICE.replace("TILT=NONE", "TILT=INCLUDE\n1\n2\n0 90\n1 0.5");
    let (mut read_well, mut refused) = (0, 0);
    let mut count = |bytes: &[u8]| match read(bytes) {
        Ok(Photometry { profile, .. }) => {
            assert!(profile.candela().iter().all(|value| value.is_finite() && *value >= 0.0));
            assert!(profile.integral(|_| 1.0, &[]).is_finite());
            read_well += 1;
        }
        Err(Mistake { line, message }) => {
            assert!((1..=30).contains(&line) && !message.is_empty(), "{line}: {message}");
            refused += 1;
        }
    };
    for text in [OFFICE, &tilted] {
        for end in 0..text.len() {
            count(&text.as_bytes()[..end]);
        }
        for place in 0..text.len() {
            for byte in [b'0', b'9', b'-', b'.', b'e', b' ', b'\n', b'=', 0, 0xff] {
                let mut bytes = text.as_bytes().to_vec();
                bytes[place] = byte;
                count(&bytes);
                bytes.insert(place, byte);
                count(&bytes);
                bytes.drain(place..(place + 3).min(bytes.len()));
                count(&bytes);
            }
        }
    }
    assert!(read_well > 1000 && refused > 1000, "{read_well} and {refused}");
}
