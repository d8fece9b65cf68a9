//! A moment in time, as RFC 3339 writes it.

/// A moment, in universal time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// Days from January 1, 2000, 0 h, to the beginning of the day.
    day: i64,
    /// Hours since then, from 0 to 24.
    hours: f64,
}

impl Moment {
    /// Reads `2026-06-21T12:00:00+02:00`: a date, a time of the day, and how far it is ahead of universal time, or `Z`. Seconds may be left out.
    ///
    /// # Errors
    /// A sentence about a text that is no such moment.
    pub fn read(text: &str) -> Result<Self, String> {
        let wrong = || format!("expected a time like \"2026-06-21T12:00:00+02:00\", with its zone or `Z`, found \"{text}\"");
        Self::parsed(text).ok_or_else(wrong)
    }

    fn parsed(text: &str) -> Option<Self> {
        let (date, rest) = text.split_once(['T', 't', ' '])?;
        let end = rest.find(['Z', 'z', '+', '-'])?;
        let (time, zone) = rest.split_at(end);
        let [year, month, day] = numbers(date, '-')?[..] else { return None };
        let (hour, minute, second) = match numbers(time, ':')?[..] {
            [hour, minute] => (hour, minute, 0),
            [hour, minute, second] => (hour, minute, second),
            _ => return None,
        };
        let ahead = match zone {
            "Z" | "z" => 0,
            _ => {
                let [hours, minutes] = numbers(&zone[1..], ':')?[..] else { return None };
                if hours > 23 || minutes > 59 {
                    return None;
                }
                (60 * hours + minutes) * if zone.starts_with('-') { -1 } else { 1 }
            }
        };
        let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
        let days = [31, if is_leap { 29 } else { 28 }, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
        let days = *days.get(usize::try_from(month - 1).ok()?)?;
        if !(1950..=2050).contains(&year) || !(1..=days).contains(&day) || hour > 23 || minute > 59 || second > 60 {
            return None;
        }
        let seconds = 3600 * hour + 60 * (minute - ahead) + second;
        let day = days_since_2000(year, month, day) + seconds.div_euclid(86_400);
        Some(Self { day, hours: seconds.rem_euclid(86_400) as f64 / 3600.0 })
    }

    /// Days since January 1, 2000, 12 h, the epoch of almanacs.
    pub fn days_since_2000(self) -> f64 {
        self.day as f64 - 0.5 + self.hours / 24.0
    }

    /// Hours of universal time since the day began.
    pub fn hours(self) -> f64 {
        self.hours
    }
}

/// Digits between separators; nothing else.
fn numbers(text: &str, separator: char) -> Option<Vec<i64>> {
    let number = |part: &str| {
        let is_short = (1..=4).contains(&part.len()) && part.bytes().all(|byte| byte.is_ascii_digit());
        if is_short { part.parse().ok() } else { None }
    };
    text.split(separator).map(number).collect()
}

/// Days of the Gregorian calendar, counted in years that begin in March, so that a leap day is a year's last.
fn days_since_2000(year: i64, month: i64, day: i64) -> i64 {
    let year = if month > 2 { year } else { year - 1 };
    let days_before_month = (153 * ((month + 9) % 12) + 2) / 5;
    365 * year + year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400) + days_before_month + day - 730_426
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_read_and_nonsense_is_refused() {
        let read = |text: &str| Moment::read(text).map(|moment| (moment.day, moment.hours));
        assert_eq!(read("2000-01-01T00:00:00Z"), Ok((0, 0.0)));
        assert_eq!(read("2000-01-01T12:30Z"), Ok((0, 12.5)));
        assert_eq!(read("2000-03-01T00:00:00Z"), Ok((60, 0.0)));
        assert_eq!(read("2001-01-01T01:00:00+02:00"), Ok((365, 23.0)));
        assert_eq!(read("1999-12-31T23:00:00-01:30"), Ok((0, 0.5)));
        assert_eq!(read("2026-06-21T12:00:00+02:00"), Ok((9668, 10.0)));
        for wrong in [
            "",
            "noon",
            "2026-06-21",
            "2026-06-21T12:00:00",
            "2026-02-29T12:00:00Z",
            "2026-13-01T12:00Z",
            "2026-00-01T12:00Z",
            "2026-06-21T24:00Z",
            "2026-06-21T12:60Z",
            "1900-06-21T12:00Z",
            "2026-06-21T12:00+2",
            "2026-06-21T12Z",
            "2026-06-21T1é:00Z",
            "99999-06-21T12:00Z",
            "2026-06-21T12:00:00+99:00",
            "-2026-06-21T12:00:00Z",
        ] {
            assert!(
                read(wrong).is_err_and(|message| message.contains("2026-06-21T12:00:00+02:00")),
                "{wrong}: {:?}",
                read(wrong)
            );
        }
    }
}
