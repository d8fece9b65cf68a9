//! A caustic, for measurements of light that paths find by chance.

/// A glass ball under a small lamp: its caustic is found by paths that meet the lamp by chance.
pub const CAUSTIC: &str = "[film]\nsize = [128, 128]\n[camera]\nposition = [0, 4, 7]\nlook_at = [0, 0.4, 0]\nvfov = 40\n\
    [[material]]\nname = \"white\"\ntype = \"diffuse\"\nreflectance = 0.7\n\
    [[material]]\nname = \"glass\"\ntype = \"glass\"\nior = 1.5\n\
    [[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = 60\n\
    [[shape]]\ntype = \"rectangle\"\nmaterial = \"white\"\ncorner = [-6, 0, 6]\nedge_u = [12, 0, 0]\nedge_v = [0, 0, -12]\n\
    [[shape]]\ntype = \"sphere\"\nmaterial = \"glass\"\ncenter = [0, 1, 0]\nradius = 1\n\
    [[shape]]\ntype = \"sphere\"\nmaterial = \"lamp\"\ncenter = [-3, 5, -1]\nradius = 0.4\n[render]\nmax_depth = 8\n";
