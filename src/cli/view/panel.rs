//! A panel that a page may have beside the picture, with requests of its own.

/// The panel, and whoever answers its requests. Only a page that has one may change anything.
pub trait Panel: Send + Sync {
    /// The text that follows the page's own parts: its style, its elements and its scripts.
    fn parts(&self) -> String;

    /// The answer to a GET; None: there is no such page.
    fn get(&self, path: &str) -> Option<Reply>;

    /// The answer to a POST by the page itself; None: there is no such page.
    fn post(&self, path: &str, body: &[u8]) -> Option<Reply>;
}

/// An answer.
pub struct Reply {
    pub status: &'static str,
    pub kind: &'static str,
    pub body: Vec<u8>,
}

impl Reply {
    /// An answer that holds what was asked for, as JSON.
    pub fn json(body: Vec<u8>) -> Self {
        Self { status: "200 OK", kind: "application/json", body }
    }

    /// The reason why it cannot be had.
    pub fn refused(status: &'static str, why: String) -> Self {
        Self { status, kind: "text/plain; charset=utf-8", body: why.into_bytes() }
    }
}
