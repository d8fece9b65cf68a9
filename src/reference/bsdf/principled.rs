//! The material of glTF 2.0's Appendix B: its layers, with one index of refraction or one for each channel.

use glam::DVec3;

use super::channels::choose_channel;
use super::lookup::Lookup;
use super::principled_layers::{PrincipledLayers, Way};
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::view::View;
use crate::scene::MaterialKind;
use crate::spectrum::Spectrum;

/// Each channel is scattered by the layers as if all had its index of refraction. One channel is drawn, by what the path carries of each, and then a
/// direction by its layers. A direction counts for all channels that may come from there, over the density with which any of them draws it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Principled {
    pub layers: PrincipledLayers,
    /// The channels' indices of refraction, inside over outside; None where they are alike.
    pub iors: Option<Spectrum>,
}

impl Principled {
    fn of_channels(&self, iors: Spectrum) -> [PrincipledLayers; 3] {
        iors.to_rgb().map(|ior| PrincipledLayers { ior, ..self.layers })
    }
}

impl Scatter for Principled {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::Principled(written) = kind else { return None };
        Some(Self { layers: PrincipledLayers::of(written, lookup), iors: written.iors() })
    }

    fn sampling_weight(&self) -> f64 {
        self.layers.sampling_weight()
    }

    fn is_delta(&self) -> bool {
        self.layers.is_delta()
    }

    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        let Some(iors) = self.iors else { return self.layers.evaluate(view, wi) };
        let carried = view.carried_shares().to_rgb();
        let evaluations = self.of_channels(iors).map(|layers| layers.evaluate(view, wi));
        Evaluation {
            value: Spectrum::from_rgb([0, 1, 2].map(|channel| evaluations[channel].value.to_rgb()[channel])),
            pdf: (0..3).map(|channel| carried[channel] * evaluations[channel].pdf).sum(),
        }
    }

    fn sample(&self, view: &View, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        let Some(iors) = self.iors else { return self.layers.sample(view, u_lobe, u1, u2) };
        let carried = view.carried_shares().to_rgb();
        let layers = self.of_channels(iors);
        let (chosen, left) = choose_channel(carried, u_lobe)?;
        let drawn = layers[chosen].draw(view, &layers[chosen].shares(view), left, u1, u2)?;
        if !self.layers.is_smooth(drawn.way) {
            let Evaluation { value, pdf } = self.evaluate(view, drawn.wi);
            return if pdf > 0.0 { drawn.with_weight(value / pdf, Density::SolidAngle(pdf)) } else { None };
        }
        let (mut value, mut probability) = ([0.0; 3], 0.0);
        for (channel, of_channel) in layers.iter().enumerate() {
            // Channels that are refracted otherwise come from elsewhere.
            if drawn.way != Way::Transmission || iors.to_rgb()[channel] == iors.to_rgb()[chosen] {
                let (light, share) = of_channel.of_smooth(view, &of_channel.shares(view), drawn);
                value[channel] = light.to_rgb()[channel];
                probability += carried[channel] * share;
            }
        }
        drawn.with_weight(Spectrum::from_rgb(value) / probability, Density::Delta)
    }
}
