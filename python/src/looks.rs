//! Pictures of a render that goes on.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use gpt::{Band, Observer};
use serde_json::json;

use crate::pictures::{HandsOver, Look, Message};
use crate::watching::Watcher;

/// Looks at a render whenever somebody waits for a picture and enough time has passed since the last one.
pub struct Looks<'a> {
    watcher: &'a Watcher,
    hands_over: HandsOver<'a>,
    scene: &'a gpt::Scene,
    device: String,
    size: [u32; 2],
    every: Duration,
    kept: Mutex<Kept>,
}

/// The picture as it was seen last.
struct Kept {
    pixels: Vec<[f32; 3]>,
    counts: Vec<u32>,
    last: Option<Instant>,
}

impl<'a> Looks<'a> {
    pub fn new(
        watcher: &'a Watcher,
        hands_over: HandsOver<'a>,
        (scene, device, size): (&'a gpt::Scene, &str, [u32; 2]),
        every: Duration,
    ) -> Self {
        let pixels = size[0] as usize * size[1] as usize;
        let kept = Mutex::new(Kept { pixels: vec![[0.0; 3]; pixels], counts: vec![0; pixels], last: None });
        Self { watcher, hands_over, scene, device: device.to_owned(), size, every, kept }
    }

    fn stats(&self, counts: &[u32]) -> String {
        let [width, height] = self.size;
        let samples: u64 = counts.iter().map(|&count| u64::from(count)).sum();
        json!({
            "scene": self.scene.name,
            "device": self.device,
            "width": width,
            "height": height,
            "spp": self.scene.render.spp,
            "spp_done": counts.iter().copied().min(),
            "samples": samples,
            "stopped_by": null,
        })
        .to_string()
    }
}

impl Observer for Looks<'_> {
    fn progress(&self, done: u64, total: u64) {
        self.watcher.progress(done, total);
    }

    fn stop_requested(&self) -> bool {
        self.watcher.stop_requested()
    }

    fn is_abandoned(&self) -> bool {
        self.watcher.is_abandoned()
    }

    fn wants_rows(&self) -> bool {
        let is_time = || {
            let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
            kept.last.is_none_or(|last| last.elapsed() >= self.every)
        };
        self.watcher.is_waited_for() && is_time()
    }

    fn rows_so_far(&self, rows: Band) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let start = rows.first_row as usize * rows.width as usize;
        let Some(place) = kept.pixels.get_mut(start..start + rows.mean.len()) else { return };
        place.copy_from_slice(&rows.mean);
        let counts = rows.counts.unwrap_or_else(|| vec![rows.samples; rows.mean.len()]);
        if let Some(place) = kept.counts.get_mut(start..start + counts.len()) {
            place.copy_from_slice(&counts);
        }
        // A picture is whole.
        if kept.counts.contains(&0) {
            return;
        }
        kept.last = Some(Instant::now());
        let [width, height] = self.size;
        if let Some(image) = gpt::Image::from_pixels(width, height, kept.pixels.clone()) {
            let stats = self.stats(&kept.counts);
            drop(kept);
            // A render that nobody listens to is about to end.
            let _ = (self.hands_over)(Message::Look(Box::new(Look { image, stats })));
        }
    }
}
