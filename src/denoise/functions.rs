//! The library's functions that are called, by the names and types of its C interface (`oidn.h`, versions 1.4 to 2).

use std::ffi::{c_char, c_int, c_void};

use libloading::Library;

/// A device or a filter of the library.
pub(super) type Handle = *mut c_void;

/// Functions of an open library; they may be called as long as it is open.
pub(super) struct Functions {
    pub new_device: unsafe extern "C" fn(c_int) -> Handle,
    pub commit_device: unsafe extern "C" fn(Handle),
    pub release_device: unsafe extern "C" fn(Handle),
    pub device_number: unsafe extern "C" fn(Handle, *const c_char) -> c_int,
    pub device_error: unsafe extern "C" fn(Handle, *mut *const c_char) -> c_int,
    pub new_filter: unsafe extern "C" fn(Handle, *const c_char) -> Handle,
    /// Name, memory, format, width, height, offset, and strides of pixels and rows in bytes, where 0 is without gaps.
    pub set_image: unsafe extern "C" fn(Handle, *const c_char, *mut c_void, c_int, usize, usize, usize, usize, usize),
    pub set_flag: unsafe extern "C" fn(Handle, *const c_char, bool),
    pub commit_filter: unsafe extern "C" fn(Handle),
    pub execute_filter: unsafe extern "C" fn(Handle),
    pub release_filter: unsafe extern "C" fn(Handle),
}

impl Functions {
    /// Looks the functions up.
    pub(super) fn of(library: &Library) -> Result<Self, libloading::Error> {
        // SAFETY: the names and types are those of `oidn.h`, which do not change within versions 1.4 to 2; two have an older name too, of the
        // same type.
        unsafe {
            Ok(Self {
                new_device: *library.get(b"oidnNewDevice\0")?,
                commit_device: *library.get(b"oidnCommitDevice\0")?,
                release_device: *library.get(b"oidnReleaseDevice\0")?,
                device_number: *library.get(b"oidnGetDeviceInt\0").or_else(|_| library.get(b"oidnGetDevice1i\0"))?,
                device_error: *library.get(b"oidnGetDeviceError\0")?,
                new_filter: *library.get(b"oidnNewFilter\0")?,
                set_image: *library.get(b"oidnSetSharedFilterImage\0")?,
                set_flag: *library.get(b"oidnSetFilterBool\0").or_else(|_| library.get(b"oidnSetFilter1b\0"))?,
                commit_filter: *library.get(b"oidnCommitFilter\0")?,
                execute_filter: *library.get(b"oidnExecuteFilter\0")?,
                release_filter: *library.get(b"oidnReleaseFilter\0")?,
            })
        }
    }
}
