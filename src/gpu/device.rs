//! An open device, and what went wrong on it.

use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};

use crate::plan::{DeviceLimits, PlanOptions};
use crate::renderer::{DeviceChoice, RenderError};

/// A device with its queue, and the first error it reported. Clones are the same device.
#[derive(Clone)]
pub struct Device {
    pub name: String,
    pub limits: DeviceLimits,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    failure: Arc<Mutex<Option<Failure>>>,
}

/// A device that a thread of its own opens, which takes a tenth of a second or more.
pub struct OpeningDevice(Opening);

enum Opening {
    Open(Box<Device>),
    /// None once it was waited for.
    Thread(Option<JoinHandle<Result<Device, RenderError>>>),
}

impl OpeningDevice {
    /// Begins to open the adapter that `choice` means; see [`Device::open_for`].
    pub fn begin(choice: &DeviceChoice, options: &PlanOptions) -> Self {
        let (choice, options) = (choice.clone(), options.clone());
        Self(Opening::Thread(Some(thread::spawn(move || Device::open_for(&choice, &options)))))
    }

    /// One that needs no waiting.
    pub fn is_open(device: &Device) -> Self {
        Self(Opening::Open(Box::new(device.clone())))
    }

    /// The device, once it is open.
    ///
    /// # Errors
    /// As [`Device::open_for`].
    pub fn wait(mut self) -> Result<Device, RenderError> {
        match &mut self.0 {
            Opening::Open(device) => Ok(Device::clone(device)),
            Opening::Thread(thread) => {
                let opened = thread.take().map(JoinHandle::join);
                let panicked = || Err(RenderError::Internal("opening the device panicked".to_owned()));
                opened.unwrap_or_else(|| Ok(panicked())).unwrap_or_else(|_| panicked())
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
            // Whether it opened does not matter any more.
            let _ = thread.join();
        }
    }
}

enum Failure {
    Lost(String),
    OutOfMemory(String),
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

    /// As [`Device::open`], with what plans with these options need besides.
    ///
    /// # Errors
    /// As [`Device::open`]; [`RenderError::DoesNotFit`] where the adapter lacks what they ask for.
    pub fn open_for(choice: &DeviceChoice, options: &PlanOptions) -> Result<Self, RenderError> {
        let adapter = super::adapters::select_adapter(choice)?;
        let mut limits = DeviceLimits::of(&adapter);
        if options.asks_for_ray_queries() {
            limits.check_ray_queries(&adapter.get_info().name)?;
        } else {
            // What is not enabled is not there.
            limits.ray_queries = None;
        }
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
            // SAFETY: it is acknowledged that wgpu's ray queries may have bugs of their own. They are enabled on request alone; what is asked
            // of them keeps to their contract: ranges are finite and ordered, and hits that kernels report lie within them.
            experimental_features = unsafe { wgpu::ExperimentalFeatures::enabled() };
        }
        // Only measurements ask for the time; nothing else of the device changes by it.
        features |= adapter.features() & wgpu::Features::TIMESTAMP_QUERY;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("gpt"),
            required_features: features,
            required_limits: adapter.limits(),
            experimental_features,
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| RenderError::NoDevice(format!("{} cannot be opened: {error}", adapter.get_info().name)))?;
        let failure = Arc::new(Mutex::new(None));
        let seen = Arc::clone(&failure);
        device.on_uncaptured_error(Arc::new(move |error| {
            let failure = match error {
                wgpu::Error::OutOfMemory { source } => Failure::OutOfMemory(source.to_string()),
                other => Failure::Other(other.to_string()),
            };
            remember(&seen, failure);
        }));
        let seen = Arc::clone(&failure);
        device.set_device_lost_callback(move |reason, message| {
            if reason != wgpu::DeviceLostReason::Destroyed {
                remember(&seen, Failure::Lost(message));
            }
        });
        Ok(Self { name: adapter.get_info().name, limits, device, queue, failure })
    }

    /// The first error since the device was opened.
    pub fn check(&self) -> Result<(), RenderError> {
        let failure = self.failure.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        match &*failure {
            None => Ok(()),
            Some(Failure::Lost(message)) => Err(RenderError::DeviceLost(message.clone())),
            Some(Failure::OutOfMemory(message)) => {
                Err(RenderError::DoesNotFit(format!("{} ran out of memory: {message}", self.name)))
            }
            Some(Failure::Other(message)) => Err(RenderError::Internal(message.clone())),
        }
    }

    /// Submits commands and waits until they are done.
    pub fn submit_and_wait(&self, commands: wgpu::CommandBuffer) -> Result<(), RenderError> {
        self.queue.submit([commands]);
        self.wait()
    }

    /// Waits for everything submitted.
    pub fn wait(&self) -> Result<(), RenderError> {
        let polled = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        polled.map(|_| ()).map_err(|error| RenderError::DeviceLost(error.to_string()))
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
        buffer.map_async(wgpu::MapMode::Read, .., |_| {});
        self.wait()?;
        let view = buffer.get_mapped_range(..).map_err(|error| RenderError::Internal(error.to_string()))?;
        let bytes = view.to_vec();
        drop(view);
        buffer.unmap();
        Ok(bytes)
    }
}

fn remember(slot: &Mutex<Option<Failure>>, failure: Failure) {
    let mut slot = slot.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    slot.get_or_insert(failure);
}
