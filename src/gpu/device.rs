//! An open device, and what went wrong on it.

use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::compiled::CompiledKernels;
use super::driver_thread::{DriverThread, Fate, OPENING_THREAD, keep_panics_quiet, message};
use super::limits::{driver_identity, limits_for_plans};
use crate::plan::{DeviceLimits, PlanOptions};
use crate::renderer::{DeviceChoice, RenderError};

/// A device with its queue, and the first error it reported. Clones are the same device.
#[derive(Clone)]
pub struct Device {
    pub name: String,
    /// With the version of its driver ([`driver_identity`]).
    pub driver: String,
    pub limits: DeviceLimits,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    failure: Arc<Mutex<Option<Failure>>>,
    driver_thread: Arc<DriverThread>,
    /// The kernels that were compiled last, for the next frame of a scene.
    pub(super) kernels: Arc<CompiledKernels>,
}

/// The time that a submission may take, where nothing else is said.
pub const DEFAULT_TIMEOUT: Duration = Duration::from_secs(60);
/// The time that a submission may take on software devices, which compile kernels on the processor: a minute
/// for a scene of many features, more where others keep it busy.
const SOFTWARE_TIMEOUT: Duration = Duration::from_secs(300);
/// The words of wgpu where a device is given up because its memory is used up.
const OUT_OF_MEMORY: &str = "Out of memory";

/// A device that a thread of its own opens, which takes a tenth of a second or more.
pub struct OpeningDevice(Opening);

enum Opening {
    Open(Box<Device>),
    /// None once it was waited for.
    Done(Option<Result<Device, RenderError>>),
    Thread(Option<JoinHandle<Result<Device, RenderError>>>),
}

impl OpeningDevice {
    /// Begins to open the adapter that `choice` means; see [`Device::open_for`].
    pub fn begin(choice: &DeviceChoice, options: &PlanOptions) -> Self {
        let open = {
            let (choice, options) = (choice.clone(), options.clone());
            move || Device::open_for(&choice, &options)
        };
        keep_panics_quiet();
        match thread::Builder::new().name(OPENING_THREAD.to_owned()).spawn(open) {
            Ok(thread) => Self(Opening::Thread(Some(thread))),
            // The system starts no more threads: then the device opens before anything else is done.
            Err(_) => Self(Opening::Done(Some(Device::open_for(choice, options)))),
        }
    }

    /// Limits of the device; None before it was waited for.
    pub fn limits(&self) -> Option<&DeviceLimits> {
        match &self.0 {
            Opening::Open(device) => Some(&device.limits),
            Opening::Done(_) | Opening::Thread(_) => None,
        }
    }

    /// A device that needs no waiting.
    pub fn already_open(device: &Device) -> Self {
        Self(Opening::Open(Box::new(device.clone())))
    }

    /// The device, once it is open.
    ///
    /// # Errors
    /// [`RenderError`] as of [`Device::open_for`].
    pub fn wait(mut self) -> Result<Device, RenderError> {
        match &mut self.0 {
            Opening::Open(device) => Ok(Device::clone(device)),
            Opening::Done(device) => {
                device.take().unwrap_or_else(|| Err(RenderError::Internal("the device is taken".to_owned())))
            }
            Opening::Thread(thread) => {
                let taken = || Err(RenderError::Internal("the device is taken".to_owned()));
                let refused =
                    |why: String| Err(RenderError::NoDevice(format!("the driver failed while it was being opened ({why})")));
                let opened = thread.take().map(JoinHandle::join);
                opened.map_or_else(taken, |opened| opened.unwrap_or_else(|payload| refused(message(&*payload))))
            }
        }
    }
}

impl Drop for OpeningDevice {
    /// Waits: a process must not end while a driver is being loaded.
    fn drop(&mut self) {
        if let Opening::Thread(thread) = &mut self.0
            && let Some(thread) = thread.take()
        {
            // The outcome does not matter any more.
            let _ = thread.join();
        }
    }
}

enum Failure {
    Lost(String),
    OutOfMemory { message: String, is_lost: bool },
    Other(String),
}

impl Device {
    /// Opens the adapter that `choice` means, with the limits it has and no feature beyond what the renderer can use.
    ///
    /// # Errors
    /// [`RenderError::NoDevice`] where there is no such adapter or it cannot be opened.
    pub fn open(choice: &DeviceChoice) -> Result<Self, RenderError> {
        Self::open_for(choice, &PlanOptions::default())
    }

    /// [`Device::open`] with the features that plans with these options need besides.
    ///
    /// # Errors
    /// [`RenderError`] as of [`Device::open`]; [`RenderError::DoesNotFit`] where the adapter lacks what they
    /// ask for.
    pub fn open_for(choice: &DeviceChoice, options: &PlanOptions) -> Result<Self, RenderError> {
        let adapter = super::adapters::select_adapter(choice)?;
        let limits = limits_for_plans(&adapter, options)?;
        let mut features = wgpu::Features::empty();
        if limits.read_write_rgba32float {
            features |= wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES;
        }
        if limits.subgroups {
            features |= wgpu::Features::SUBGROUP;
        }
        let mut experimental_features = wgpu::ExperimentalFeatures::disabled();
        if limits.ray_queries.is_some() {
            features |= wgpu::Features::EXPERIMENTAL_RAY_QUERY;
            // SAFETY: it is acknowledged that wgpu's ray queries may have bugs of their own. They are enabled on request, and where they were
            // verified; what is asked of them keeps to their contract: ranges are finite and ordered, and hits that kernels report lie within them.
            experimental_features = unsafe { wgpu::ExperimentalFeatures::enabled() };
        }
        // Only measurements ask for the time; nothing else of the device changes by it.
        features |= adapter.features() & wgpu::Features::TIMESTAMP_QUERY;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("gpt"),
            required_features: features,
            required_limits: adapter.limits(),
            experimental_features,
            // Scenes, paths and films are few large arrays: blocks of many megabytes, which a driver takes milliseconds to pin, would stay empty.
            memory_hints: wgpu::MemoryHints::MemoryUsage,
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| RenderError::NoDevice(format!("{} cannot be opened: {error}", adapter.get_info().name)))?;
        let failure = Arc::new(Mutex::new(None));
        let seen = Arc::clone(&failure);
        device.on_uncaptured_error(Arc::new(move |error| {
            let failure = match error {
                wgpu::Error::OutOfMemory { source } => Failure::OutOfMemory { message: source.to_string(), is_lost: false },
                other => Failure::Other(other.to_string()),
            };
            remember(&seen, failure);
        }));
        let seen = Arc::clone(&failure);
        device.set_device_lost_callback(move |reason, message| match reason {
            wgpu::DeviceLostReason::Destroyed => {}
            _ if message.contains(OUT_OF_MEMORY) => {
                remember(&seen, Failure::OutOfMemory { message, is_lost: true });
            }
            _ => remember(&seen, Failure::Lost(message)),
        });
        let usual = if limits.software { SOFTWARE_TIMEOUT } else { DEFAULT_TIMEOUT };
        let driver_thread = Arc::new(DriverThread::start(options.device_timeout.unwrap_or(usual)));
        let info = adapter.get_info();
        let driver = driver_identity(&info);
        Ok(Self { name: info.name, driver, limits, device, queue, failure, driver_thread, kernels: Arc::default() })
    }

    /// The first error since the device was opened.
    pub fn check(&self) -> Result<(), RenderError> {
        let failure = self.failure.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        match &*failure {
            None => Ok(()),
            Some(Failure::Lost(message)) => Err(RenderError::DeviceLost(format!("{}: {message}", self.name))),
            Some(Failure::OutOfMemory { message, .. }) => {
                Err(RenderError::DoesNotFit(format!("{} ran out of memory: {message}", self.name)))
            }
            Some(Failure::Other(message)) => Err(RenderError::Internal(message.clone())),
        }
    }

    /// Says that nothing more can be asked of the device.
    pub fn is_lost(&self) -> bool {
        let failure = self.failure.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        failure.is_some()
    }

    /// Goes on after the device refused memory; false where that is not what happened, or cost the device.
    pub fn forget_refusal(&self) -> bool {
        let mut failure = self.failure.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let refused = matches!(*failure, Some(Failure::OutOfMemory { is_lost: false, .. }));
        if refused {
            *failure = None;
        }
        refused
    }

    /// Keeps a lost device from being closed, which a driver that hangs never finishes.
    pub fn leave_if_lost(&self) {
        if self.is_lost() {
            std::mem::forget((self.device.clone(), self.queue.clone(), self.kernels.clone()));
        }
    }

    /// Submits commands and waits until they are done.
    ///
    /// # Errors
    /// [`RenderError`] that the device reports; [`RenderError::DeviceLost`] where it does not answer in time.
    pub fn submit_and_wait(&self, commands: wgpu::CommandBuffer) -> Result<(), RenderError> {
        self.wait_after(Some(commands))
    }

    /// Waits for everything submitted.
    ///
    /// # Errors
    /// [`RenderError`] as of [`Device::submit_and_wait`].
    pub fn wait(&self) -> Result<(), RenderError> {
        self.wait_after(None)
    }

    fn wait_after(&self, commands: Option<wgpu::CommandBuffer>) -> Result<(), RenderError> {
        self.check()?;
        let (device, queue) = (self.device.clone(), self.queue.clone());
        let timeout = Some(self.driver_thread.limit());
        let polled = self.driver_thread.run(move || {
            if let Some(commands) = commands {
                queue.submit([commands]);
            }
            device.poll(wgpu::PollType::Wait { submission_index: None, timeout }).map(|_| ())
        });
        // The first error says most about what went wrong.
        self.check()?;
        let failure = match polled {
            Ok(Ok(())) => return Ok(()),
            Ok(Err(wgpu::PollError::Timeout)) => Failure::Lost(no_answer(self.driver_thread.limit())),
            Err(Fate::Hangs(waited)) => Failure::Lost(no_answer(waited)),
            Ok(Err(error)) => Failure::Lost(error.to_string()),
            Err(Fate::Panicked(message)) => Failure::Lost(message),
        };
        remember(&self.failure, failure);
        self.check()
    }

    /// A buffer through which the host reads what is copied to it.
    pub fn readback_buffer(&self, size: u64) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        })
    }

    /// Reads the first bytes of a buffer that can be copied from.
    pub fn read_start(&self, source: &wgpu::Buffer, bytes: u64) -> Result<Vec<u8>, RenderError> {
        let target = self.readback_buffer(bytes);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(source, 0, &target, 0, bytes);
        self.submit_and_wait(encoder.finish())?;
        self.read(&target)
    }

    /// Reads a whole buffer that can be mapped, once everything submitted is done.
    pub fn read(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, RenderError> {
        self.read_mapped(buffer, buffer.size(), <[u8]>::to_vec)
    }

    /// The result of `look` at the first bytes of a buffer that can be mapped, once everything submitted is
    /// done.
    pub fn read_mapped<T>(&self, buffer: &wgpu::Buffer, bytes: u64, look: impl FnOnce(&[u8]) -> T) -> Result<T, RenderError> {
        buffer.map_async(wgpu::MapMode::Read, ..bytes, |_| {});
        self.wait()?;
        let view = buffer.get_mapped_range(..bytes).map_err(|error| RenderError::Internal(error.to_string()))?;
        let seen = look(&view);
        drop(view);
        buffer.unmap();
        Ok(seen)
    }
}

fn remember(slot: &Mutex<Option<Failure>>, failure: Failure) {
    let mut slot = slot.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    slot.get_or_insert(failure);
}

/// The message that a device did not answer. A wait shorter than `--device-timeout` means that the program
/// was to end.
fn no_answer(waited: std::time::Duration) -> String {
    format!("it did not answer for {} s (--device-timeout)", (waited.as_secs_f64() * 10.0).round() / 10.0)
}
