//! Software drivers: the releases of Mesa's lavapipe, what is wrong with some of them, and what others can do.

use wgpu::{AdapterInfo, DeviceType};

/// Lanes of a software adapter's vectors. Lavapipe makes wider ones only where it is told to, and Mesa 25.0.7 then computes half of the
/// lanes' paths wrong, without a word.
const MOST_SOFTWARE_LANES: u32 = 8;

/// The oldest release of Mesa whose software driver renders. Those of 22.3.6 and 24.0.5 end all loops of an invocation, without a word, when they
/// have gone round 65,535 times together; a kernel that takes one pixel after the other goes round more often, and loses samples. Those of 25.0.7
/// and 25.2.8 lose none.
const OLDEST_SOFTWARE_MESA: u32 = 25;

/// The first release of Mesa, with its minor number, whose software driver loads for all lanes of a vector by one gather; older ones load lane by
/// lane. Measured with 25.2.8 and 26.2.6 against 25.0.7 (docs/notes/2026-11-29-drivers.md).
const FIRST_MESA_WITH_GATHERS: [u32; 2] = [25, 1];

/// Advice for a software driver without gathers (docs/notes/2026-11-29-drivers.md).
const NEWER_MESA: &str = "Mesa 25.1 and newer render large scenes in 0.7 to 0.9 of the time (Debian 13: from trixie-backports, Ubuntu 24.04: from noble-updates)";

/// The software driver that browsers bring along. Its compiler took 223 s for the kernel of a model of 124,008 triangles; for that of `cornell` it took
/// 20 GiB of memory and had not ended.
const SWIFTSHADER: &str = "SwiftShader";

/// Why the renderer cannot use this driver, if it is a software one.
pub fn obstacle(info: &AdapterInfo) -> Option<String> {
    if info.device_type != DeviceType::Cpu {
        return None;
    }
    if let Some(release) =
        mesa_release(&info.driver_info).map(|[major, _]| major).filter(|&release| release < OLDEST_SOFTWARE_MESA)
    {
        return Some(format!(
            "loses samples of pictures in Mesa {release}; it takes Mesa {OLDEST_SOFTWARE_MESA} or newer \
             (Debian 12: from bookworm-backports, Ubuntu 24.04: from noble-updates)"
        ));
    }
    if info.name.contains(SWIFTSHADER) {
        return Some(
            "takes minutes and 20 GiB of memory to compile a kernel; Mesa's lavapipe takes a fraction of a second".to_owned(),
        );
    }
    (info.subgroup_min_size > MOST_SOFTWARE_LANES).then(|| {
        format!(
            "leaves parts of pictures black with vectors of {} lanes; unset LP_NATIVE_VECTOR_WIDTH or set it to 256",
            info.subgroup_min_size
        )
    })
}

/// The first two numbers of Mesa's version, as drivers tell it: `Mesa 24.0.5-1ubuntu1 (LLVM 17.0.6)` is 24 and 0.
fn mesa_release(driver_info: &str) -> Option<[u32; 2]> {
    let mut numbers = driver_info.split_once("Mesa ")?.1.split(|letter: char| !letter.is_ascii_digit()).map(str::parse);
    Some([numbers.next()?.ok()?, numbers.next()?.ok()?])
}

/// A way to render faster, where the driver is an old lavapipe.
pub fn advice(info: &AdapterInfo) -> Option<&'static str> {
    let is_lavapipe = info.device_type == DeviceType::Cpu && mesa_release(&info.driver_info).is_some();
    (is_lavapipe && !gathers(info)).then_some(NEWER_MESA)
}

/// Says that a software driver loads for all lanes of a vector at once, wherever their addresses lie.
pub fn gathers(info: &AdapterInfo) -> bool {
    info.device_type == DeviceType::Cpu
        && mesa_release(&info.driver_info).is_some_and(|release| release >= FIRST_MESA_WITH_GATHERS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_release_of_mesa_is_read_from_what_drivers_tell() {
        assert_eq!(mesa_release("Mesa 24.0.5-1ubuntu1 (LLVM 17.0.6)"), Some([24, 0]));
        assert_eq!(mesa_release("Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)"), Some([25, 0]));
        assert_eq!(mesa_release("Mesa 25.2.8-0ubuntu0.24.04.5 (LLVM 20.1.2)"), Some([25, 2]));
        assert_eq!(mesa_release("Mesa 26.3.0-devel (git-0123456789)"), Some([26, 3]));
        assert_eq!(mesa_release("570.133.20"), None);
        assert!(mesa_release("Mesa 22.3.6 (LLVM 15.0.6)").is_some_and(|[major, _]| major < OLDEST_SOFTWARE_MESA));
    }
}
