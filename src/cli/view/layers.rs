//! Layers of the picture as the page shows them.

use std::sync::Arc;

use gpt::output::{LayerChannel, LayerPicture, LayerSource};

/// A layer: one to three numbers a pixel.
#[derive(Debug, Clone)]
pub struct LayerImage {
    pub name: String,
    pub width: u32,
    pub height: u32,
    /// The channel of each of the three numbers; a layer of one number has it three times.
    places: [usize; 3],
    picture: Arc<LayerPicture>,
}

/// The layers that these channels are of. Those that are made with the picture itself (variances, numbers of samples) and mattes are not among them.
pub fn layer_images(channels: &[LayerChannel], [width, height]: [u32; 2]) -> Vec<LayerImage> {
    let mut layers: Vec<LayerImage> = Vec::new();
    for channel in channels {
        let (LayerSource::Component(picture, place) | LayerSource::Whole(picture, place)) = &channel.source else { continue };
        let (name, component) = match channel.name.rsplit_once('.') {
            Some((name, _)) => (name, *place),
            None => (&*channel.name, 0),
        };
        if name.to_lowercase().starts_with("crypto") {
            continue;
        }
        match layers.iter_mut().find(|layer| layer.name == name) {
            Some(layer) if component < 3 => {
                layer.places[component] = *place;
                if component == 1 {
                    // The third number of a layer of two is 0.
                    layer.places[2] = 2;
                }
            }
            Some(_) => {}
            None => {
                layers.push(LayerImage { name: name.to_owned(), width, height, places: [*place; 3], picture: picture.clone() })
            }
        }
    }
    layers
}

impl LayerImage {
    /// Its numbers, row by row from the top.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn pixels(&self) -> std::io::Result<Vec<[f32; 3]>> {
        let mut pixels = Vec::with_capacity(self.width as usize * self.height as usize);
        for row in 0..self.height {
            pixels.extend(self.picture.row(row)?.iter().map(|pixel| self.places.map(|place| pixel[place])));
        }
        Ok(pixels)
    }
}

#[cfg(test)]
mod tests {
    use gpt::output::SAMPLE_COUNT;

    use super::*;

    #[test]
    fn channels_become_layers_of_three_numbers() {
        let picture = Arc::new(LayerPicture::new([2, 1]).expect("a temporary file"));
        picture.write_rows(0, &[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]).expect("it is written");
        let component = |name: &'static str, place| LayerChannel::new(name, LayerSource::Component(picture.clone(), place));
        let count = LayerChannel::new(SAMPLE_COUNT, LayerSource::Count);
        let channels =
            [component("N.X", 0), component("N.Y", 1), component("N.Z", 2), count, component("Z", 0), component("A", 1)];
        let layers = layer_images(&channels, [2, 1]);
        let names: Vec<_> = layers.iter().map(|layer| layer.name.as_str()).collect();
        assert_eq!(names, ["N", "Z", "A"]);
        let pixels = |index: usize| layers[index].pixels().expect("it is read");
        assert_eq!(pixels(0), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        assert_eq!((pixels(1)[1], pixels(2)[1]), ([4.0; 3], [5.0; 3]));
    }
}
