//! Open Image Denoise where it is installed.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::{Path, PathBuf};

use libloading::Library as SharedLibrary;

use super::functions::{Functions, Handle};

/// Names the library or the folder that it is in.
pub const VARIABLE: &str = "GPT_OIDN";

/// File names of the library, the newest version first.
#[cfg(target_os = "linux")]
const NAMES: &[&str] = &["libOpenImageDenoise.so.2", "libOpenImageDenoise.so", "libOpenImageDenoise.so.1"];
#[cfg(target_os = "macos")]
const NAMES: &[&str] = &["libOpenImageDenoise.2.dylib", "libOpenImageDenoise.dylib"];
#[cfg(not(any(target_os = "linux", target_os = "macos")))]
const NAMES: &[&str] = &["OpenImageDenoise.dll"];

/// The processor: its results are the same everywhere, near enough, and memory needs not be moved.
const PROCESSOR: c_int = 1;
/// Three numbers of single precision a pixel.
const FLOAT3: c_int = 3;

/// Why nothing was denoised.
#[derive(Debug, thiserror::Error)]
pub enum OidnError {
    #[error(
        "Open Image Denoise is not installed, as far as can be seen{0}: `pip install pyoidn` brings it (in an environment that is active), \
         distributions have it as libopenimagedenoise or oidn, and github.com/RenderKit/oidn as a download; {VARIABLE} names the library or \
         its folder where it is elsewhere"
    )]
    Missing(String),
    #[error("{} is not Open Image Denoise 1.4 or 2: {what}", path.display())]
    Unsuitable { path: PathBuf, what: String },
    #[error("Open Image Denoise: {0}")]
    Failed(String),
}

/// The library, open.
pub struct Library {
    functions: Functions,
    /// Whence the functions come; it stays open as long as they may be called.
    _library: SharedLibrary,
    path: PathBuf,
}

/// Images of one size, three numbers a pixel, by the names that the library's filter `RT` has for them; the first decides what comes out.
pub struct Task<'a> {
    pub size: [usize; 2],
    pub inputs: &'a [(&'static str, &'a Vec<[f32; 3]>)],
    pub flags: &'a [&'static str],
}

impl Library {
    /// Opens the library: the one that [`VARIABLE`] names, else that of an active Python environment, the user's or the system's.
    ///
    /// # Errors
    /// There is none, or it is another one.
    pub fn open() -> Result<Self, OidnError> {
        if let Some(named) = std::env::var_os(VARIABLE) {
            let named = PathBuf::from(named);
            let path = if named.is_dir() { in_folder(&named) } else { Some(named.clone()).filter(|path| path.is_file()) };
            let path = path.ok_or_else(|| OidnError::Missing(format!(" ({VARIABLE} is {})", named.display())))?;
            return Self::open_at(&path);
        }
        if let Some(path) = python_folders().iter().find_map(|folder| in_folder(folder)) {
            return Self::open_at(&path);
        }
        // The system knows where its own libraries are.
        let system = NAMES.iter().map(|name| Self::open_at(Path::new(name)));
        system.into_iter().find_map(Result::ok).ok_or_else(|| OidnError::Missing(String::new()))
    }

    fn open_at(path: &Path) -> Result<Self, OidnError> {
        let unsuitable = |error: libloading::Error| OidnError::Unsuitable { path: path.to_owned(), what: error.to_string() };
        // SAFETY: opening a library runs its initialisers. It is the one that the person or the system has under this name, as with any
        // library that a program is linked to.
        let library = unsafe { SharedLibrary::new(path) }.map_err(unsuitable)?;
        let functions = Functions::of(&library).map_err(unsuitable)?;
        Ok(Self { functions, _library: library, path: path.to_owned() })
    }

    /// The path at which it was found.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its version, such as 2.5.1.
    ///
    /// # Errors
    /// The processor is not one that it works on.
    pub fn version(&self) -> Result<String, OidnError> {
        let device = self.device()?;
        let number = |name: &CStr| {
            // SAFETY: the device is alive, and the name ends in 0.
            unsafe { (self.functions.device_number)(device.handle, name.as_ptr()) }
        };
        Ok(format!("{}.{}.{}", number(c"versionMajor"), number(c"versionMinor"), number(c"versionPatch")))
    }

    fn device(&self) -> Result<Device<'_>, OidnError> {
        // SAFETY: the type is one that `oidn.h` has.
        let handle = unsafe { (self.functions.new_device)(PROCESSOR) };
        let device = Device { functions: &self.functions, handle };
        if handle.is_null() {
            return Err(device.error().unwrap_or_else(|| OidnError::Failed("it makes no device of this processor".to_owned())));
        }
        // SAFETY: the device was just made.
        unsafe { (self.functions.commit_device)(handle) };
        device.error().map_or(Ok(device), Err)
    }

    /// Denoises the first of the images, by the help of the others.
    ///
    /// # Errors
    /// Images of other sizes, and what the library says.
    pub fn run(&self, task: &Task) -> Result<Vec<[f32; 3]>, OidnError> {
        let [width, height] = task.size;
        if task.inputs.iter().any(|(_, values)| values.len() != width * height) {
            return Err(OidnError::Failed("the picture and its layers differ in size".to_owned()));
        }
        let device = self.device()?;
        let functions = &self.functions;
        let mut output = vec![[0.0_f32; 3]; width * height];
        // SAFETY: the device is alive, and the name ends in 0.
        let filter = Filter { functions, handle: unsafe { (functions.new_filter)(device.handle, c"RT".as_ptr()) } };
        if filter.handle.is_null() {
            return Err(device.error().unwrap_or_else(|| OidnError::Failed("it makes no filter".to_owned())));
        }
        let set_image = |name: &str, memory: *mut c_void| {
            let name = terminated(name);
            // SAFETY: the memory holds width × height pixels of three numbers without gaps, and outlives the filter's run. The library reads
            // inputs only, though its interface takes them as mutable.
            unsafe { (functions.set_image)(filter.handle, name.as_ptr(), memory, FLOAT3, width, height, 0, 0, 0) };
        };
        for (name, values) in task.inputs {
            set_image(name, values.as_ptr().cast_mut().cast());
        }
        set_image("output", output.as_mut_ptr().cast());
        for flag in task.flags {
            let name = terminated(flag);
            // SAFETY: the filter is alive, and the name ends in 0.
            unsafe { (functions.set_flag)(filter.handle, name.as_ptr(), true) };
        }
        // SAFETY: the filter is alive, and all of its images are.
        unsafe {
            (functions.commit_filter)(filter.handle);
            (functions.execute_filter)(filter.handle);
        }
        drop(filter);
        device.error().map_or(Ok(output), Err)
    }
}

/// A name as C has it.
fn terminated(name: &str) -> CString {
    CString::new(name).expect("the names above have no 0 in them")
}

/// A device of the library, which is released in the end.
struct Device<'a> {
    functions: &'a Functions,
    handle: Handle,
}

impl Device<'_> {
    /// The last error since it was asked last.
    fn error(&self) -> Option<OidnError> {
        let mut message: *const c_char = std::ptr::null();
        // SAFETY: the place for the message is valid; without a device, the library tells what went wrong in making one.
        let code = unsafe { (self.functions.device_error)(self.handle, &mut message) };
        if code == 0 {
            return None;
        }
        if message.is_null() {
            return Some(OidnError::Failed(format!("error {code}")));
        }
        // SAFETY: the library's text ends in 0 and stays until the next error.
        let text = unsafe { CStr::from_ptr(message) };
        Some(OidnError::Failed(text.to_string_lossy().into_owned()))
    }
}

impl Drop for Device<'_> {
    fn drop(&mut self) {
        if !self.handle.is_null() {
            // SAFETY: it was made by the library and is released once.
            unsafe { (self.functions.release_device)(self.handle) };
        }
    }
}

/// A filter of the library, which is released in the end.
struct Filter<'a> {
    functions: &'a Functions,
    handle: Handle,
}

impl Drop for Filter<'_> {
    fn drop(&mut self) {
        if !self.handle.is_null() {
            // SAFETY: it was made by the library and is released once.
            unsafe { (self.functions.release_filter)(self.handle) };
        }
    }
}

/// The library in a folder, or in the folder of a Python package below it.
fn in_folder(folder: &Path) -> Option<PathBuf> {
    let folders = [folder.to_owned(), folder.join("lib"), folder.join("pyoidn/oidn/lib")];
    folders.iter().flat_map(|folder| NAMES.iter().map(move |name| folder.join(name))).find(|path| path.is_file())
}

/// The folders of Python packages: of the active environment, of the user, of the system.
fn python_folders() -> Vec<PathBuf> {
    let environment = |name: &str| std::env::var_os(name).map(PathBuf::from);
    let roots = [environment("VIRTUAL_ENV"), environment("CONDA_PREFIX"), environment("HOME").map(|home| home.join(".local"))];
    let roots = roots.into_iter().flatten().chain(["/usr/local", "/usr"].map(PathBuf::from));
    let mut folders = Vec::new();
    for root in roots {
        for entry in std::fs::read_dir(root.join("lib")).into_iter().flatten().flatten() {
            if entry.file_name().to_string_lossy().starts_with("python3") {
                folders.extend(["site-packages", "dist-packages"].map(|name| entry.path().join(name)));
            }
        }
        folders.push(root.join("Lib").join("site-packages"));
    }
    folders
}
