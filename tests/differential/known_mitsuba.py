"""What does not agree with Mitsuba 3.9.1, and why. A row of which every scene agrees fails the comparison, so that this list stays true.

A row is a pattern of names of scenes, the verdict that they have unless they agree, and the reason. Verdicts: `differs`, `refused here`, `refused there`,
`refused by both`, `blind` (5 % more light would not be noticed) and `tests nothing` (Mitsuba's picture does not depend on the parameter)."""

KNOWN = [
    (r"^shape cylinder: (normal|bump) map: |^shape sphere: (bump map: turn|(bump|normal) map: mirrored in x)$", "tests nothing", "on this part of the shape Mitsuba's picture hardly shows the map"),
    (r"^bsdf bumpmap: texture: not raw$", "tests nothing", "decoded or not, these heights bend normals alike but for noise"),
    (r"^shape obj: filename: without normals and coordinates, plain, face_normals$", "tests nothing", "Mitsuba's picture hardly shows whether this body is smooth"),
    # Mitsuba does not read it.
    (r"rgb in hexadecimal$|rgb: value: hexadecimal in capitals", "refused there", "Mitsuba 3 reads no hexadecimal colours; 0.6 did"),
    (r"spectrum of three values$", "refused there", "Mitsuba 3 reads no colour in `<spectrum>`; 0.6 did"),
    (r"rawconstant of three$", "refused there", "it takes a vector, and no `<rgb>`"),
    (r": (ir)?regular plugin$", "refused there", "written as plugins, these have no colour in Mitsuba's RGB mode"),
    (r"blackbody plugin", "refused there", "it has no colour in Mitsuba's RGB mode"),
    (r"^bsdf diffuse: reflectance: above 1$", "refused there", "Mitsuba refuses reflectances above 1; here it is a warning"),
    (r"^bsdf blendbsdf: weight: not given$", "refused there", "Mitsuba's blend needs its weight"),
    (r"^bsdf conductor: material: (Ni|Pd|Pt|Ti|Cs|V|Na)$", "refused there", "the package of PyPI has no file of this metal"),
    (r"^bsdf roughconductor: alpha_u: not given$", "refused there", "Mitsuba wants `alpha_u` and `alpha_v` together"),
    (r"^bsdf roughdielectric: int_ior, ext_ior: equal$", "refused there", "Mitsuba refuses equal indices"),
    (r"^bsdf bumpmap: texture: a checkerboard$", "refused there", "Mitsuba has no slope of a checkerboard"),
    (r"^document boolean: value: blanks$", "refused there", "Mitsuba wants no blanks"),
    (r"^document (color|srgb): |^old version scene: spelling: srgb", "refused there", "Mitsuba 3 does not have the element; 0.6 did"),
    (r"^document float: value: (long|suffix)$", "refused there", "Mitsuba 3 does not read the spelling"),
    (r"^document point: value: point of x alone$", "refused there", "Mitsuba 3 wants all three"),
    (r"^emitter spot: texture: rgb$", "refused there", "Mitsuba wants a texture that varies"),
    (r"^integrator none: ", "refused there", "Mitsuba wants an integrator"),
    (r"^old version bsdf ", "refused there", "Mitsuba 3 does not have the plugin; 0.6 did"),
    (r"^old version scene: spelling: uvscale$", "refused there", "Mitsuba 3 brings `uscale` and `vscale` up to date alone"),
    (r"^sensor (perspective|thinlens): to_world: (uniform|uneven)? ?(scale|shear)", "refused there", "Mitsuba's cameras take no scale"),
    (r"^texture mesh_attribute: name: one that is not there$", "refused there", "Mitsuba refuses the scene"),
    (r"^document boolean: value: 1$|^document rgb: value: (four|two|hexadecimal, short)$|^document scene: structure: default (in braces|within a word)$|^sensor thinlens: aperture_radius: not given$", "refused by both", "it is not valid"),
    # Mitsuba is wrong, or says that it does not mean it.
    (r"^emitter (directional: direction, to_world: to_world with a scale|projector: to_world: scaled|projector: to_world: scaled in the world|envmap: to_world: scaled)$", "differs", "Mitsuba's light takes the scale for brightness or size"),
    (r"^bsdf (blendbsdf|mask): bsdf: .*(mirror|glass|plastic)", "differs", "Mitsuba's blends count mirrors and glass wrongly, in which one direction alone is possible"),
    (r"^sampler stratified: jitter: false$", "differs", "Mitsuba's samples lie on a grid, which is not what a pixel's mean is"),
    (r"^integrator volpathmis: rr_depth: 2, in a medium$", "differs", "Mitsuba's picture darkens with less `rr_depth`, by `volpathmis` alone: its roulette takes light away"),
    (r"^integrator (ptracer: max_depth: 3|direct: bsdf_samples: 0)$", "differs", "what cannot be sampled from a light is missing there"),
    (r"^bsdf plastic: int_ior, ext_ior: int_ior by name$", "differs", "Mitsuba takes a polynomial for the mean of Fresnel's equations; here it is integrated"),
    (r"^shape (sphere|cylinder): .*(uneven|shear|scale, then turn|turn, then scale)", "differs", "Mitsuba warns that it takes no uneven scale, and draws something round"),
    # Another model here, which is told by a warning.
    (r"principled", "differs", "glTF's principled material stands for Disney's, whose lobes are others"),
    (r"^bsdf (rough)?conductor: eta, k: (eta|k) as a bitmap$", "differs", "an index that varies over a surface is not exact here"),
    (r"^bsdf normalmap: normalmap: (within|one part of) a blend$", "differs", "parts of a blend with maps that are not alike lie as the surface does"),
    (r"to_uv: (shear|turn, then scale)$|^emitter (spot: texture|projector: irradiance): to_uv$", "differs", "texture coordinates are turned and scaled here, and not sheared"),
    (r"^texture checkerboard: color0, color1: color\d a ", "differs", "fields of a checkerboard are constants here"),
    (r"^emitter directionalarea: ", "differs", "left out here"),
    (r"^emitter sunsky: ", "differs", "a plain blue sky and a sun without extent stand for the model"),
    (r"^sensor (perspective|orthographic): (near|far)_clip: ", "differs", "nothing is cut off here"),
    (r"^sensor orthographic: to_world: shear$", "differs", "pictures are not sheared here"),
    (r"^rfilter (mitchell|catmullrom|lanczos): ", "differs", "filters have no negative parts here"),
    (r"^integrator depth: ", "differs", "paths are traced"),
    (r"^volume gridvolume: wrap_mode: repeat$", "differs", "at the border of a grid its own voxels count alone here"),
    (r"^volume gridvolume: to_world: turned by 30$", "differs", "nothing is outside of a grid's own box here; there its border goes on to the corners of an upright box"),
    (r"^phase tabphase: values: ahead$", "differs", "a table is Henyey's and Greenstein's phase function of its mean cosine here"),
    (r"^integrator prbvolpath: ", "refused there", "it is there in variants that differentiate alone"),
    (r"^shape instance: to_world.*(mirrored|uneven|turn, then scale|scale, then turn|shear)", "differs", "spheres of instances: uneven scales and mirrors as for spheres"),
    # Not told, and small.
    (r"spectrum of (pairs|a file)", "differs", "the CIE's tables are integrated by other steps: up to 0.8 % where a spectrum ends within the visible range"),
    (r"^bsdf roughplastic: |over roughplastic", "differs", "Mitsuba reads the light that the coat lets through from a table; here it is integrated: up to 1.6 %"),
    (r"^rfilter (gaussian|tent|none): ", "differs", "gaussians end at three deviations here, at four there; and no sample beyond the film's edge counts there, which shows with wide filters"),
    (r"^shape (obj|ply|serialized|cylinder): .*(light|glass)", "differs", "where interpolated normals bend away from the faces', Mitsuba decides by them which side gives light or refracts; here the face decides"),
    (r"^shape (obj|ply|serialized): (texture coordinates|to_world|flip_normals|filename|bump map|normal map): ((?!mirrored in x$).)*$", "differs", "the same, on a diffuse surface seen along it: up to 1 %; and vertex normals that are computed are weighted otherwise: up to 3 %"),
    (r"^emitter area: bsdf of the shape: null", "differs", "what gives light stops light here"),
    # Open.
    (r"^shape \w+: (normal|bump) map: mirrored in x$", "differs", "open: maps on mirrored shapes"),
    (r"^bsdf normalmap: normalmap: within twosided, from behind$", "differs", "open: normal maps seen from behind"),
    (r"^document transform: steps: lookat without up$", "differs", "open: Mitsuba chooses another up"),
    (r"^document transform: steps: (projective matrix|matrix with a last number of 2)$", "refused here", "a matrix has 0, 0, 0, 1 as its last row"),
    (r"^integrator path: max_depth: 0$", "refused here", "the picture is black"),
    (r"floats\.pfm|grey-floats\.exr|(floats|sky)\.hdr|^bsdf bumpmap: texture: in single precision$", "refused here", "open: PFM, EXR of one channel, Radiance with the signature `#?RGBE`"),
]

_OWN = "a key or a value of gpt's own scene files"
_OLD = "of version 0.6, and not of Mitsuba 3"
_LEFT_OUT = "left out here with a warning"
_NOTHING = "of Mitsuba's own doing, without a bearing on what is compared"

# Words of the importer that no scene here holds, by the reason.
_WORDS = {
    _OWN: "transmittance coat black mixture hidden gold copper silver aluminium aluminum face vertex emitters roulette_depth spp",
    _OLD: "ext_eta sample_all use_fast_approx disney bump thickness sigma_a specular_sampling_rate camera luminaire cache max_smooth_angle collapse "
    "optimize kd_tree load_materials has_vertex_normals silica srgb_d65 animation strict_normals monochrome samples hide_environment sample_center "
    "bdpt mlt pssmlt erpt volpath_simple photonmapper irrcache sppm mis path_mis multichannel adaptive scramble dimension telecentric "
    "perspective_rdist thinlens_rdist mixturephase microflake apple chicken1 chicken2 cream ketchup marble potato skimmilk skin1 skin2 spectralon "
    "wholemilk banner high_quality_edges attach_log exposure key burn tonemap_method file_name channel_names label "
    "max_anisotropy to_srgb channel int_i_o_r ext_i_o_r diffuse_amount specular_amount gamma sun collimated subsurface",
    _LEFT_OUT: "sggx hair linecurve bsplinecurve heightfield sdfgrid ellipsoids ellipsoidsmesh deformable",
    _NOTHING: "silhouette_discontinuity srf stokes prb prb_basic data rgbe",
}
NOT_IN_SCENES = {word: reason for reason, words in _WORDS.items() for word in words.split()}
