//! Examples of cameras, which tests render: together they use whatever cameras have code for.

/// An example of a camera.
#[derive(Debug, Clone, Copy)]
pub struct CameraExample {
    pub name: &'static str,
    /// Pixels of its picture.
    pub size: [u32; 2],
    /// The keys of `[camera]` that say how it sees.
    pub keys: &'static str,
}

const fn example(name: &'static str, size: [u32; 2], keys: &'static str) -> CameraExample {
    CameraExample { name, size, keys }
}

/// All examples.
pub const CAMERA_EXAMPLES: &[CameraExample] = &[
    example("panorama", [48, 24], "projection = \"equirectangular\"\n"),
    example("part of a panorama", [40, 30], "projection = \"equirectangular\"\nazimuth = [-40, 70]\nelevation = [-30, 45]\n"),
    example("cylinder", [48, 24], "projection = \"cylindrical\"\nazimuth = [-100, 100]\n"),
    example("high cylinder", [40, 40], "projection = \"cylindrical\"\nazimuth = [-60, 60]\nelevation = [-50, 70]\n"),
    example("equidistant fisheye", [36, 30], "projection = \"fisheye\"\nfov = 200\n"),
    example("equisolid fisheye", [36, 30], "projection = \"fisheye\"\nfov = 180\nmapping = \"equisolid\"\nfit = \"diagonal\"\n"),
    example(
        "stereographic fisheye",
        [36, 30],
        "projection = \"fisheye\"\nfov = 230\nmapping = \"stereographic\"\nfit = \"width\"\n",
    ),
    example(
        "orthographic fisheye",
        [36, 30],
        "projection = \"fisheye\"\nfov = 180\nmapping = \"orthographic\"\nfit = \"height\"\n",
    ),
    example("cube map in a row", [72, 12], "projection = \"cube_map\"\n"),
    example("cube map in a grid", [48, 32], "projection = \"cube_map\"\nlayout = \"grid\"\n"),
    example(
        "distorted perspective",
        [40, 30],
        "projection = \"brown_conrady\"\nfocal = [38, 36]\nprincipal_point = [21.5, 14]\nradial = [-0.28, 0.07, -0.01, 0.02, 0.01, 0.003]\n\
         tangential = [0.004, -0.006]\n",
    ),
    example(
        "calibrated perspective",
        [40, 30],
        "projection = \"brown_conrady\"\nfocal = [76, 72]\nprincipal_point = [43, 28]\nimage_size = [80, 60]\n",
    ),
    example(
        "distorted perspective through a lens",
        [40, 30],
        "projection = \"brown_conrady\"\nfocal = [38, 38]\nradial = [-0.25, 0.05]\naperture = { shape = \"disk\", radius = 0.1 }\nfocus_distance = 5\n",
    ),
    example(
        "polynomial fisheye",
        [40, 30],
        "projection = \"kannala_brandt\"\nfocal = [12, 12]\nprincipal_point = [20.5, 14.5]\nradial = [-0.02, 0.004, -0.003, 0.0004]\n",
    ),
    example(
        "pair of perspectives",
        [60, 24],
        "vfov = 50\nstereo = { layout = \"side_by_side\", eye_distance = 0.3, convergence = 6 }\n",
    ),
    example(
        "pair of parallel views",
        [40, 48],
        "projection = \"orthographic\"\nheight = 5\nstereo = { layout = \"top_bottom\", eye_distance = 0.3, convergence = 6 }\n",
    ),
    example(
        "pair of fisheyes",
        [60, 30],
        "projection = \"fisheye\"\nfov = 180\nstereo = { layout = \"side_by_side\", eye_distance = 0.3 }\n",
    ),
    example(
        "omnidirectional stereo",
        [48, 48],
        "projection = \"equirectangular\"\nstereo = { layout = \"top_bottom\", eye_distance = 0.3, convergence = 4 }\n",
    ),
    example(
        "stereo on a cylinder",
        [64, 16],
        "projection = \"cylindrical\"\nazimuth = [-90, 90]\nstereo = { layout = \"side_by_side\", eye_distance = 0.3 }\n",
    ),
];
