//! Requests by HTTP, as far as a page of our own makes them, and who may make them.

use std::io::{self, BufRead, ErrorKind, Read, Write};

/// Longest request that is read; browsers send about a kilobyte.
const MOST_BYTES: u64 = 16 << 10;
/// Longest body that is read.
const MOST_BODY_BYTES: u64 = 1 << 20;

/// A request of a browser.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Request {
    pub method: String,
    /// Without the query.
    pub path: String,
    pub query: String,
    pub host: Option<String>,
    /// The page that makes the request, as the browser says it.
    pub origin: Option<String>,
    pub content_type: Option<String>,
    /// Bytes that follow the head. None: the request does not say it, or says it in another way.
    pub length: Option<u64>,
}

/// The reason why what a request brings is not looked at.
#[derive(Debug, PartialEq, Eq)]
pub struct Refusal {
    pub status: &'static str,
    pub why: &'static str,
}

impl Request {
    /// Reads a request up to the end of its head; what follows is not looked at.
    ///
    /// # Errors
    /// `InvalidData` for what is no request or too long; what the connection reports.
    pub fn read(connection: impl BufRead) -> io::Result<Self> {
        let mut lines = connection.take(MOST_BYTES);
        let first = line(&mut lines)?;
        let mut words = first.split(' ');
        let (Some(method), Some(target), Some(version), None) = (words.next(), words.next(), words.next(), words.next()) else {
            return Err(invalid());
        };
        if !version.starts_with("HTTP/1.") || !target.starts_with('/') {
            return Err(invalid());
        }
        let (path, query) = target.split_once('?').unwrap_or((target, ""));
        let mut request = Self { method: method.to_owned(), path: path.to_owned(), query: query.to_owned(), ..Self::default() };
        loop {
            let header = line(&mut lines)?;
            if header.is_empty() {
                return Ok(request);
            }
            let (name, value) = header.split_once(':').ok_or_else(invalid)?;
            let value = value.trim();
            let field = match name.to_ascii_lowercase().as_str() {
                "host" => &mut request.host,
                "origin" => &mut request.origin,
                "content-type" => &mut request.content_type,
                "content-length" => {
                    // Digits alone, and once.
                    let length = value.bytes().all(|byte| byte.is_ascii_digit()).then(|| value.parse().ok()).flatten();
                    if length.is_none() || request.length.is_some() {
                        return Err(invalid());
                    }
                    request.length = length;
                    continue;
                }
                "transfer-encoding" => return Err(invalid()),
                _ => continue,
            };
            // Two of them are none: proxies have been led astray by that.
            if field.replace(value.to_owned()).is_some() {
                return Err(invalid());
            }
        }
    }

    /// The content that the request brings, if the page that this server gave out makes it: a page of another origin cannot send JSON without asking first, and a
    /// browser tells whose request it is.
    ///
    /// # Errors
    /// The reason why it is not looked at; behind that, errors of the connection.
    pub fn body_of_own_page(&self, connection: &mut impl BufRead) -> Result<io::Result<Vec<u8>>, Refusal> {
        let own = self.host.as_deref().map(|host| format!("http://{host}"));
        if self.origin.is_none() || self.origin != own {
            return Err(Refusal { status: "403 Forbidden", why: "Only the page itself may ask for that.\n" });
        }
        if self.content_type.as_deref() != Some("application/json") {
            return Err(Refusal { status: "415 Unsupported Media Type", why: "It must be application/json.\n" });
        }
        let length = self.length.ok_or(Refusal { status: "411 Length Required", why: "Its length is missing.\n" })?;
        if length > MOST_BODY_BYTES {
            return Err(Refusal { status: "413 Content Too Large", why: "It is too long.\n" });
        }
        let mut body = vec![0; length as usize];
        Ok(connection.read_exact(&mut body).map(|()| body))
    }

    /// Reads what follows the head and forgets it: whoever is refused is still sending, and would not see the answer otherwise.
    pub fn skip_body(&self, connection: &mut impl BufRead) {
        let length = self.length.unwrap_or(0).min(MOST_BODY_BYTES);
        // Nobody minds where it ends too soon.
        let _ = io::copy(&mut connection.take(length), &mut io::sink());
    }

    /// A value of the query; ours need no escapes.
    pub fn parameter(&self, name: &str) -> Option<&str> {
        self.query.split('&').filter_map(|pair| pair.split_once('=')).find(|(key, _)| *key == name).map(|(_, value)| value)
    }
}

fn line(lines: &mut impl BufRead) -> io::Result<String> {
    let mut line = String::new();
    lines.read_line(&mut line)?;
    let Some(line) = line.strip_suffix('\n') else { return Err(invalid()) };
    Ok(line.strip_suffix('\r').unwrap_or(line).to_owned())
}

fn invalid() -> io::Error {
    io::Error::new(ErrorKind::InvalidData, "it is no request")
}

/// Decides who may ask: who knows the secret, and came by an address of this machine. A page of another origin whose name was made to lead here asks by
/// that name.
pub struct AccessCheck {
    secret: String,
    hosts: [String; 2],
}

impl AccessCheck {
    pub fn new(secret: String, port: u16) -> Self {
        Self { secret, hosts: ["127.0.0.1", "localhost"].map(|host| format!("{host}:{port}")) }
    }

    /// The path behind the secret, of the part of the page that is asked for. None where nothing may be
    /// answered.
    pub fn admit<'r>(&self, request: &'r Request) -> Option<&'r str> {
        let host = request.host.as_deref()?;
        if !self.hosts.iter().any(|known| known.eq_ignore_ascii_case(host)) {
            return None;
        }
        let (secret, rest) = request.path.strip_prefix('/')?.split_once('/')?;
        same(secret.as_bytes(), self.secret.as_bytes()).then_some(rest)
    }
}

/// Compares in a time that does not tell where they differ.
fn same(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).fold(0, |differences, (a, b)| differences | (a ^ b)) == 0
}

/// Sends an answer and what every answer says: it stays on this machine, in no cache and in no other page.
///
/// # Errors
/// Errors of the connection.
pub fn answer(mut connection: impl Write, status: &str, kind: &str, body: &[u8], with_body: bool) -> io::Result<()> {
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\nCache-Control: no-store\r\n\
         X-Content-Type-Options: nosniff\r\nX-Frame-Options: DENY\r\nReferrer-Policy: no-referrer\r\n\
         Cross-Origin-Resource-Policy: same-origin\r\nContent-Security-Policy: default-src 'none'; connect-src 'self'; \
         img-src data: blob:; script-src 'unsafe-inline'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'\r\n\r\n",
        body.len()
    );
    connection.write_all(head.as_bytes())?;
    if with_body {
        connection.write_all(body)?;
    }
    connection.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Option<Request> {
        Request::read(text.as_bytes()).ok()
    }

    #[test]
    fn requests_are_read_and_nonsense_is_refused() {
        let request = read("GET /a/b?x=1&y=2 HTTP/1.1\r\nUser-Agent: x\r\nhost: localhost:80\r\n\r\nrest").expect("a request");
        assert_eq!((request.path.as_str(), request.parameter("y"), request.parameter("z")), ("/a/b", Some("2"), None));
        assert_eq!(request.host.as_deref(), Some("localhost:80"));
        let endless = format!("GET / HTTP/1.1\r\n{}", "a: b\r\n".repeat(10_000));
        for bad in [
            "",
            "GET /",
            "GET / HTTP/1.1\r\n",
            "GET http://a/ HTTP/1.1\r\n\r\n",
            "GET / x HTTP/1.1\r\n\r\n",
            "GET / SPDY/9\r\n\r\n",
            "GET / HTTP/1.1\r\nno colon\r\n\r\n",
            "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n",
            "POST / HTTP/1.1\r\nOrigin: a\r\nOrigin: b\r\n\r\n",
            "POST / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n",
            "POST / HTTP/1.1\r\nContent-Length: +1\r\n\r\n",
            "POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n",
            &endless,
        ] {
            assert_eq!(read(bad), None, "{bad:.40}");
        }
        assert!(Request::read([0xff, 0xfe, b'\n'].as_slice()).is_err());
    }

    #[test]
    fn the_door_opens_to_the_secret_by_this_machines_name() {
        let access = AccessCheck::new("secret".to_owned(), 80);
        let ask = |path: &str, host: Option<&str>| {
            let request =
                Request { method: "GET".into(), path: path.into(), host: host.map(str::to_owned), ..Request::default() };
            access.admit(&request).map(str::to_owned)
        };
        assert_eq!(ask("/secret/", Some("127.0.0.1:80")).as_deref(), Some(""));
        assert_eq!(ask("/secret/state", Some("LOCALHOST:80")).as_deref(), Some("state"));
        for (path, host) in [
            ("/", Some("localhost:80")),
            ("/secret", Some("localhost:80")),
            ("/Secret/", Some("localhost:80")),
            ("/secre/", Some("localhost:80")),
            ("/secrets/", Some("localhost:80")),
            ("//secret/", Some("localhost:80")),
            ("/secret/", None),
            ("/secret/", Some("localhost")),
            ("/secret/", Some("localhost:81")),
            ("/secret/", Some("evil.example:80")),
            ("/secret/", Some("localhost:80.evil.example")),
        ] {
            assert_eq!(ask(path, host), None, "{path} {host:?}");
        }
    }

    #[test]
    fn only_the_page_itself_may_change_anything() {
        let good = [
            ("Host", "127.0.0.1:80"),
            ("Origin", "http://127.0.0.1:80"),
            ("Content-Type", "application/json"),
            ("Content-Length", "2"),
        ];
        let post = |headers: &[(&str, &str)]| {
            let head: String = headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
            let text = format!("POST /secret/edit HTTP/1.1\r\n{head}\r\n{{}}rest");
            let mut connection = text.as_bytes();
            let request = Request::read(&mut connection).expect("a request");
            request.body_of_own_page(&mut connection).map(|body| body.expect("it is there")).map_err(|refusal| refusal.status)
        };
        assert_eq!(post(&good).as_deref(), Ok(b"{}".as_slice()));
        for (index, value, status) in [
            (1, "http://localhost:80", "403 Forbidden"),
            (1, "http://evil.example", "403 Forbidden"),
            (1, "https://127.0.0.1:80", "403 Forbidden"),
            (1, "null", "403 Forbidden"),
            (2, "text/plain", "415 Unsupported Media Type"),
            (3, "1048577", "413 Content Too Large"),
        ] {
            let mut headers = good;
            headers[index].1 = value;
            assert_eq!(post(&headers), Err(status), "{value}");
        }
        for (index, status) in
            [(0, "403 Forbidden"), (1, "403 Forbidden"), (2, "415 Unsupported Media Type"), (3, "411 Length Required")]
        {
            let mut headers = good.to_vec();
            headers.remove(index);
            assert_eq!(post(&headers), Err(status));
        }
    }
}
