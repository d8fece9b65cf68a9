//! Opens a page in the user's browser, where there is one.

use std::process::{Command, Stdio};
use std::thread;

/// Asks the desktop to open the address. Without a desktop nothing happens: the address was printed.
pub fn open(url: &str) {
    let Some(mut command) = command(url) else { return };
    let spawned = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    if let Ok(mut child) = spawned {
        // So that it does not stay as a zombie. Without a thread, it does.
        let _ = thread::Builder::new().name("browser".to_owned()).spawn(move || child.wait());
    }
}

#[cfg(all(unix, not(target_os = "macos")))]
fn command(url: &str) -> Option<Command> {
    let has_screen =
        ["DISPLAY", "WAYLAND_DISPLAY"].iter().any(|name| std::env::var_os(name).is_some_and(|value| !value.is_empty()));
    has_screen.then(|| {
        let mut command = Command::new("xdg-open");
        command.arg(url);
        command
    })
}

#[cfg(target_os = "macos")]
fn command(url: &str) -> Option<Command> {
    // Over ssh there is no screen.
    std::env::var_os("SSH_CONNECTION").is_none().then(|| {
        let mut command = Command::new("open");
        command.arg(url);
        command
    })
}

#[cfg(not(unix))]
fn command(url: &str) -> Option<Command> {
    let mut command = Command::new("rundll32");
    command.args(["url.dll,FileProtocolHandler", url]);
    Some(command)
}
