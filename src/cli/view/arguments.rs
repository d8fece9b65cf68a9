//! `--view`, `--watch` and `--display`.

use clap::Args;

/// The places where a render is shown while it goes on.
#[derive(Debug, Default, Args)]
pub struct ViewArguments {
    /// Show the picture while it converges, on a page in the browser: a server on this machine alone, at an address with a secret in it. The files
    /// are written as always; the page stays until Ctrl-C
    #[arg(long)]
    pub view: bool,
    /// Render again whenever the scene or a file that it uses changes, until Ctrl-C
    #[arg(long, requires = "view", conflicts_with_all = ["frames", "checkpoint", "resume", "progress"])]
    pub watch: bool,
    /// Send the picture to tev while it converges; its port is 14158
    #[arg(long = "display", value_name = "HOST:PORT", value_parser = parse_address)]
    pub tev: Option<String>,
}

fn parse_address(text: &str) -> Result<String, String> {
    let parts = text.rsplit_once(':').filter(|(host, port)| !host.is_empty() && port.parse::<u16>().is_ok_and(|port| port > 0));
    parts.map(|_| text.to_owned()).ok_or_else(|| "expected HOST:PORT, such as localhost:14158".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_have_a_host_and_a_port() {
        for good in ["localhost:14158", "127.0.0.1:1", "[::1]:14158"] {
            assert_eq!(parse_address(good).as_deref(), Ok(good));
        }
        for bad in ["", "localhost", ":14158", "localhost:", "localhost:0", "localhost:70000"] {
            assert!(parse_address(bad).is_err(), "{bad}");
        }
    }
}
