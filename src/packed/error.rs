//! Why a scene could not be packed.

/// Why a scene could not be packed.
#[derive(Debug, thiserror::Error)]
pub enum PackError {
    #[error("the scene has {found} primitives; the hierarchy can number {limit}")]
    TooManyPrimitives { found: usize, limit: usize },
    #[error("the scene has {found} infinite planes; {limit} are possible")]
    TooManyPlanes { found: usize, limit: usize },
    #[error("the scene's textures take {} MiB, and kernels can number {} MiB", words >> 18, u32::MAX >> 18)]
    TooManyTexels { words: usize },
    #[error("the blend `{material}` and those before it have more than {limit} weights along their branches")]
    TooManyWeights { material: String, limit: usize },
    #[error("the phase functions of all media have too many parts: at most 4095 of one medium, and a million in all")]
    TooManyPhases,
    #[error("the scene has {found} media; {limit} are possible")]
    TooManyMedia { found: usize, limit: usize },
    #[error("{shape}: {message}")]
    Motion { shape: String, message: String },
    /// A mistake of this program, not of the scene.
    #[error("the packed scene is inconsistent: {0}")]
    Inconsistent(String),
}
