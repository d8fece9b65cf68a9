//! Arithmetic of three numbers.

/// A point or a direction.
pub type Vector = [f64; 3];

/// a − b.
pub fn sub(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

/// The scalar product.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product.
pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Euclid's norm.
pub fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// The direction of a vector, with length 1.
pub fn normalized(a: Vector) -> Vector {
    let scale = 1.0 / length(a);
    a.map(|axis| axis * scale)
}
