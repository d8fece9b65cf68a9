//! A Vulkan layer that makes a driver fail, for tests: the Nth call of one function returns an error, never comes back, or is never done.
//!
//! The Vulkan loader puts a layer between a program and its driver (the loader's interface for layers, version 2). This one passes everything
//! on, and looks at a few functions on the way. `GPT_FAULT=vkQueueSubmit:3:lost` names a function, which of its calls fails, and how. Of
//! `vkQueueSubmit:3@2.5:lost` it is the first call from the third on that comes at least 2.5 s after the first.
//!
//! How a call fails:
//!
//! - `lost`: `VK_ERROR_DEVICE_LOST`, and so does every later call that can say so;
//! - `memory`: `VK_ERROR_OUT_OF_DEVICE_MEMORY`, once;
//! - `refused`: `VK_ERROR_UNKNOWN`, once;
//! - `never`: the call succeeds and does nothing, so that whoever waits for its work waits for ever;
//! - `hangs`: the call does not come back.
//!
//! `GPT_FAULT_COUNTS=FILE` writes there how often each function was called, when the device is destroyed or a call hangs.

#![allow(
    clippy::undocumented_unsafe_blocks,
    reason = "all rely on the same: the loader keeps to the interface of layers, and its arguments are passed on as they came"
)]

use std::collections::BTreeMap;
use std::ffi::{CStr, c_char, c_void};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

use ash::vk;

/// An entry in the loader's chain in front of the creation of an instance or a device.
#[repr(C)]
struct LayerCreateInfo {
    s_type: vk::StructureType,
    p_next: *const c_void,
    function: i32,
    link: *mut LayerLink,
}

/// The next layer, or the driver.
#[repr(C)]
struct LayerLink {
    next: *mut LayerLink,
    get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    /// The function of a device's chain; the instance's has something else here.
    get_device_proc_addr: vk::PFN_vkGetDeviceProcAddr,
}

/// `VkNegotiateLayerInterface`.
#[repr(C)]
pub struct NegotiateLayerInterface {
    s_type: u32,
    p_next: *mut c_void,
    interface_version: u32,
    get_instance_proc_addr: Option<vk::PFN_vkGetInstanceProcAddr>,
    get_device_proc_addr: Option<vk::PFN_vkGetDeviceProcAddr>,
    get_physical_device_proc_addr: *const c_void,
}

const LOADER_INSTANCE_CREATE_INFO: i32 = 47;
const LOADER_DEVICE_CREATE_INFO: i32 = 48;
const LINK_INFO: i32 = 0;

/// The fault that is asked for.
struct Fault {
    function: String,
    call: u64,
    /// Since the function's first call.
    earliest: Duration,
    how: String,
}

/// The calls of a function.
struct Calls {
    count: u64,
    first: Instant,
}

static FAULT: OnceLock<Option<Fault>> = OnceLock::new();
static CALLS: Mutex<BTreeMap<&'static str, Calls>> = Mutex::new(BTreeMap::new());
/// That the fault came: it comes once.
static CAME: AtomicBool = AtomicBool::new(false);
static LOST: OnceLock<()> = OnceLock::new();
static NEXT_INSTANCE: OnceLock<(vk::PFN_vkGetInstanceProcAddr, vk::Instance)> = OnceLock::new();
static NEXT_DEVICE: OnceLock<(vk::PFN_vkGetDeviceProcAddr, vk::Device)> = OnceLock::new();

fn fault() -> Option<&'static Fault> {
    let read = || {
        let text = std::env::var("GPT_FAULT").ok()?;
        let mut parts = text.split(':');
        let function = parts.next()?.to_owned();
        let (call, seconds) = match parts.next()? {
            when if when.contains('@') => when.split_once('@')?,
            call => (call, "0"),
        };
        let earliest = Duration::from_secs_f64(seconds.parse().ok()?);
        Some(Fault { function, call: call.parse().ok()?, earliest, how: parts.next()?.to_owned() })
    };
    FAULT.get_or_init(read).as_ref()
}

/// The result that a call of this function gives instead of doing its work; None: it does its work.
fn instead(function: &'static str) -> Option<vk::Result> {
    let (call, time) = {
        let mut calls = CALLS.lock().expect("no call panics");
        let calls = calls.entry(function).or_insert_with(|| Calls { count: 0, first: Instant::now() });
        calls.count += 1;
        (calls.count, calls.first.elapsed())
    };
    let fault = fault()?;
    let is_due = fault.call > 0 && call >= fault.call && time >= fault.earliest;
    if fault.function == function && is_due && !CAME.swap(true, Ordering::SeqCst) {
        match fault.how.as_str() {
            "lost" => {
                let _ = LOST.set(());
            }
            "memory" => return Some(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY),
            "refused" => return Some(vk::Result::ERROR_UNKNOWN),
            "never" => return Some(vk::Result::SUCCESS),
            _ => {
                write_counts();
                loop {
                    std::thread::park();
                }
            }
        }
    }
    LOST.get().map(|()| vk::Result::ERROR_DEVICE_LOST)
}

/// Finds the loader's link in a chain of structures, and moves it on to the next layer.
unsafe fn take_link(mut chain: *const c_void, s_type: i32) -> Option<&'static LayerLink> {
    unsafe {
        while let Some(info) = chain.cast::<LayerCreateInfo>().cast_mut().as_mut() {
            if info.s_type.as_raw() == s_type && info.function == LINK_INFO {
                let link = info.link.as_ref()?;
                info.link = link.next;
                return Some(link);
            }
            chain = info.p_next;
        }
        None
    }
}

/// A function of the next layer, by the type of this one.
unsafe fn cast<T>(function: vk::PFN_vkVoidFunction) -> Option<T> {
    unsafe { function.map(|function| std::mem::transmute_copy(&function)) }
}

unsafe extern "system" fn create_instance(
    info: *const vk::InstanceCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    instance: *mut vk::Instance,
) -> vk::Result {
    unsafe {
        let Some(link) = take_link((*info).p_next, LOADER_INSTANCE_CREATE_INFO) else {
            return vk::Result::ERROR_INITIALIZATION_FAILED;
        };
        let next = (link.get_instance_proc_addr)(vk::Instance::null(), c"vkCreateInstance".as_ptr());
        let Some(next) = cast::<vk::PFN_vkCreateInstance>(next) else { return vk::Result::ERROR_INITIALIZATION_FAILED };
        let result = next(info, allocator, instance);
        if result == vk::Result::SUCCESS {
            let _ = NEXT_INSTANCE.set((link.get_instance_proc_addr, *instance));
        }
        result
    }
}

unsafe extern "system" fn create_device(
    physical: vk::PhysicalDevice,
    info: *const vk::DeviceCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    device: *mut vk::Device,
) -> vk::Result {
    unsafe {
        let Some(link) = take_link((*info).p_next, LOADER_DEVICE_CREATE_INFO) else {
            return vk::Result::ERROR_INITIALIZATION_FAILED;
        };
        if let Some(result) = instead("vkCreateDevice") {
            return result;
        }
        let instance = NEXT_INSTANCE.get().map_or(vk::Instance::null(), |(_, instance)| *instance);
        let next = (link.get_instance_proc_addr)(instance, c"vkCreateDevice".as_ptr());
        let Some(next) = cast::<vk::PFN_vkCreateDevice>(next) else { return vk::Result::ERROR_INITIALIZATION_FAILED };
        let result = next(physical, info, allocator, device);
        if result == vk::Result::SUCCESS {
            let _ = NEXT_DEVICE.set((link.get_device_proc_addr, *device));
        }
        result
    }
}

fn write_counts() {
    if let Some(path) = std::env::var_os("GPT_FAULT_COUNTS") {
        let calls = CALLS.lock().expect("no call panics");
        let lines: String = calls.iter().map(|(function, calls)| format!("{function} {}\n", calls.count)).collect();
        let _ = std::fs::write(path, lines);
    }
}

unsafe extern "system" fn destroy_device(device: vk::Device, allocator: *const vk::AllocationCallbacks<'_>) {
    write_counts();
    unsafe {
        if let Some(next) = next_of_device::<vk::PFN_vkDestroyDevice>(c"vkDestroyDevice") {
            next(device, allocator);
        }
    }
}

/// The next layer's function of this name.
unsafe fn next_of_device<T>(name: &CStr) -> Option<T> {
    let (get, device) = NEXT_DEVICE.get()?;
    unsafe { cast(get(*device, name.as_ptr())) }
}

/// Functions that may fail: each with its type and its arguments.
macro_rules! watched {
    ($($function:ident $name:literal $pfn:ident ($($argument:ident: $type:ty),*);)*) => {
        $(unsafe extern "system" fn $function($($argument: $type),*) -> vk::Result {
            if let Some(result) = instead($name) {
                return result;
            }
            let name = CStr::from_bytes_with_nul(concat!($name, "\0").as_bytes()).expect("one zero, at the end");
            match unsafe { next_of_device::<vk::$pfn>(name) } {
                Some(next) => unsafe { next($($argument),*) },
                None => vk::Result::ERROR_INITIALIZATION_FAILED,
            }
        })*

        fn watched(name: &CStr) -> Option<*const ()> {
            match name.to_str().ok()? {
                $($name => Some($function as *const ()),)*
                _ => None,
            }
        }
    };
}

watched! {
    queue_submit "vkQueueSubmit" PFN_vkQueueSubmit
        (queue: vk::Queue, count: u32, submits: *const vk::SubmitInfo<'_>, fence: vk::Fence);
    wait_for_fences "vkWaitForFences" PFN_vkWaitForFences
        (device: vk::Device, count: u32, fences: *const vk::Fence, all: vk::Bool32, timeout: u64);
    wait_semaphores "vkWaitSemaphores" PFN_vkWaitSemaphores
        (device: vk::Device, info: *const vk::SemaphoreWaitInfo<'_>, timeout: u64);
    semaphore_value "vkGetSemaphoreCounterValue" PFN_vkGetSemaphoreCounterValue
        (device: vk::Device, semaphore: vk::Semaphore, value: *mut u64);
    fence_status "vkGetFenceStatus" PFN_vkGetFenceStatus
        (device: vk::Device, fence: vk::Fence);
    create_compute_pipelines "vkCreateComputePipelines" PFN_vkCreateComputePipelines
        (device: vk::Device, cache: vk::PipelineCache, count: u32, infos: *const vk::ComputePipelineCreateInfo<'_>,
         allocator: *const vk::AllocationCallbacks<'_>, pipelines: *mut vk::Pipeline);
    create_shader_module "vkCreateShaderModule" PFN_vkCreateShaderModule
        (device: vk::Device, info: *const vk::ShaderModuleCreateInfo<'_>, allocator: *const vk::AllocationCallbacks<'_>,
         module: *mut vk::ShaderModule);
    allocate_memory "vkAllocateMemory" PFN_vkAllocateMemory
        (device: vk::Device, info: *const vk::MemoryAllocateInfo<'_>, allocator: *const vk::AllocationCallbacks<'_>,
         memory: *mut vk::DeviceMemory);
    map_memory "vkMapMemory" PFN_vkMapMemory
        (device: vk::Device, memory: vk::DeviceMemory, offset: u64, size: u64, flags: vk::MemoryMapFlags, data: *mut *mut c_void);
    create_buffer "vkCreateBuffer" PFN_vkCreateBuffer
        (device: vk::Device, info: *const vk::BufferCreateInfo<'_>, allocator: *const vk::AllocationCallbacks<'_>,
         buffer: *mut vk::Buffer);
    begin_command_buffer "vkBeginCommandBuffer" PFN_vkBeginCommandBuffer
        (commands: vk::CommandBuffer, info: *const vk::CommandBufferBeginInfo<'_>);
    end_command_buffer "vkEndCommandBuffer" PFN_vkEndCommandBuffer
        (commands: vk::CommandBuffer);
}

/// The layer's own functions.
fn own(name: &CStr) -> Option<*const ()> {
    match name.to_str().ok()? {
        "vkGetInstanceProcAddr" => Some(get_instance_proc_addr as *const ()),
        "vkGetDeviceProcAddr" => Some(get_device_proc_addr as *const ()),
        "vkCreateInstance" => Some(create_instance as *const ()),
        "vkCreateDevice" => Some(create_device as *const ()),
        "vkDestroyDevice" => Some(destroy_device as *const ()),
        // The older name of the function.
        "vkWaitSemaphoresKHR" => watched(c"vkWaitSemaphores"),
        "vkGetSemaphoreCounterValueKHR" => watched(c"vkGetSemaphoreCounterValue"),
        _ => watched(name),
    }
}

fn void_of(function: *const ()) -> vk::PFN_vkVoidFunction {
    // SAFETY: it is one of the functions above, which the loader calls by its own type.
    Some(unsafe { std::mem::transmute::<*const (), unsafe extern "system" fn()>(function) })
}

unsafe extern "system" fn get_instance_proc_addr(instance: vk::Instance, name: *const c_char) -> vk::PFN_vkVoidFunction {
    let found = own(unsafe { CStr::from_ptr(name) }).and_then(void_of);
    match (found, NEXT_INSTANCE.get()) {
        (Some(function), _) => Some(function),
        (None, Some((next, _))) => unsafe { next(instance, name) },
        (None, None) => None,
    }
}

unsafe extern "system" fn get_device_proc_addr(device: vk::Device, name: *const c_char) -> vk::PFN_vkVoidFunction {
    let found = own(unsafe { CStr::from_ptr(name) }).and_then(void_of);
    match (found, NEXT_DEVICE.get()) {
        (Some(function), _) => Some(function),
        (None, Some((next, _))) => unsafe { next(device, name) },
        (None, None) => None,
    }
}

/// The function that the loader calls first.
///
/// # Safety
/// `interface` is the loader's structure.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn vkNegotiateLoaderLayerInterfaceVersion(interface: *mut NegotiateLayerInterface) -> vk::Result {
    let interface = unsafe { &mut *interface };
    interface.interface_version = interface.interface_version.min(2);
    interface.get_instance_proc_addr = Some(get_instance_proc_addr);
    interface.get_device_proc_addr = Some(get_device_proc_addr);
    interface.get_physical_device_proc_addr = std::ptr::null();
    vk::Result::SUCCESS
}
