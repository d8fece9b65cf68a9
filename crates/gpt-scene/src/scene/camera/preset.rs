//! Other ways in which a scene is seen from where its camera stands, by their names.

use crate::choice::choices;

choices! {
    /// A way to see a scene from where its camera stands, in a picture that follows from the height of the scene's own.
    pub enum CameraPreset {
        /// Flat, with the scene's own field of view, or 40 degrees.
        Perspective = "perspective",
        /// Parallel rays, over what a perspective sees at the point that the camera looks at.
        Orthographic = "orthographic",
        /// All directions, 2:1: a panorama as viewers of such take it.
        Equirectangular = "equirectangular",
        /// All around on an upright cylinder, 3:1.
        Cylindrical = "cylindrical",
        /// An equidistant circle of 180 degrees in a square picture.
        Fisheye = "fisheye",
        /// The six sides of a cube in a row, 6:1, half as high.
        CubeMap = "cube_map",
        /// Two eyes side by side, each with a picture of the scene's own projection, or a perspective. Eyes that the scene does not state are a thirtieth of
        /// the distance of the point that the camera looks at apart, and converge there.
        Stereo = "stereo",
        /// All directions for two eyes, the left one's above: omnidirectional stereo, 1:1, twice as high.
        StereoPanorama = "stereo_panorama",
    }
}
