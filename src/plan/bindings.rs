//! Binding numbers of everything that kernels read and write.

use crate::shader::shared::shared_kinds;

shared_kinds! {
    /// The bindings of kernels, all in group 0. Chunks of an array beyond its first take numbers from 400 on
    /// ([`super::chunks`]).
    pub enum Binding {
        /// [`super::parameters::PassParameters`].
        Pass = 0 as BINDING_PASS,
        /// [`super::parameters::VertexParameters`].
        Vertex = 1 as BINDING_VERTEX,
        /// Points of the sampler's sequence.
        Sequence = 2 as BINDING_SEQUENCE,
        /// [`crate::packed::View`].
        View = 3 as BINDING_VIEW,
        Primitives = 4 as BINDING_PRIMITIVES,
        /// `packed::tables`.
        Tables = 5 as BINDING_TABLES,
        Nodes = 6 as BINDING_NODES,
        Attributes = 7 as BINDING_ATTRIBUTES,
        Texels = 8 as BINDING_TEXELS,
        PathState = 9 as BINDING_PATH_STATE,
        ShadowRays = 10 as BINDING_SHADOW_RAYS,
        Queues = 11 as BINDING_QUEUES,
        Counts = 12 as BINDING_COUNTS,
        DispatchSizes = 13 as BINDING_DISPATCH_SIZES,
        Statistics = 14 as BINDING_STATISTICS,
        FilmSum = 15 as BINDING_FILM_SUM,
        FilmCompensation = 16 as BINDING_FILM_COMPENSATION,
        /// The device's own acceleration structure.
        Acceleration = 17 as BINDING_ACCELERATION,
        /// [`super::trace_record`].
        Trace = 18 as BINDING_TRACE,
        Instances = 19 as BINDING_INSTANCES,
        /// [`crate::sampling::guide`].
        Guide = 20 as BINDING_GUIDE,
        /// [`crate::sampling::light_cells`].
        LightCells = 21 as BINDING_LIGHT_CELLS,
    }
}
