//! Reflection at the smooth boundary of a dielectric, of unpolarised light.

/// The cosine beyond the boundary by Snell's law, where `index` is the index there over the index here. None: reflected totally.
pub fn refracted(cosine: f64, index: f64) -> Option<f64> {
    let squared = 1.0 - (1.0 - cosine * cosine) / (index * index);
    (squared > 0.0).then(|| squared.sqrt())
}

/// The part that is reflected, by the cosine on this side and the index of the other side over that of this one.
pub fn reflectance(cosine: f64, index: f64) -> f64 {
    if index == 1.0 {
        return 0.0;
    }
    let Some(beyond) = refracted(cosine, index) else { return 1.0 };
    let across = (cosine - index * beyond) / (cosine + index * beyond);
    let within = (index * cosine - beyond) / (index * cosine + beyond);
    0.5 * (across * across + within * within)
}
