//! How long an orthonormal basis about a normal takes, and how exact it is: `cargo bench --bench frames`.
//!
//! Duff et al. (2017), as `gpt::math::Frame` has it, without a branch on the larger component and without a root, beside Hughes and Möller (1999),
//! who cross the normal with a vector that is perpendicular to one axis and normalise. Prints the table of docs/figures.md.

use std::hint::black_box;
use std::time::Instant;

use glam::{DVec3, Vec3};
use gpt::math::Frame;

/// Normals, in an order without a pattern.
const NORMALS: usize = 1 << 16;
/// Passes over them, of which the fastest counts.
const PASSES: usize = 60;

fn main() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let normals: Vec<DVec3> = (0..NORMALS)
        .map(|_| {
            let (z, phi) = (2.0 * random() - 1.0, std::f64::consts::TAU * random());
            let radius = (1.0 - z * z).sqrt();
            DVec3::new(radius * phi.cos(), radius * phi.sin(), z)
        })
        .collect();
    let singles: Vec<Vec3> = normals.iter().map(|normal| normal.as_vec3()).collect();
    println!("| basis | double precision, ns | single precision, ns | largest deviation, single |");
    println!("| --- | --- | --- | --- |");
    let double = fastest(&normals, |normal| {
        let frame = Frame::around(normal);
        frame.tangent + frame.bitangent
    });
    row("Duff et al. 2017", double, fastest(&singles, |normal| sum(duff(normal))), &singles, duff);
    let double = fastest(&normals, |normal| {
        let [tangent, bitangent] = hughes_moller_double(normal);
        tangent + bitangent
    });
    row("Hughes and Möller 1999", double, fastest(&singles, |normal| sum(hughes_moller(normal))), &singles, hughes_moller);
}

fn row(name: &str, double: f64, single: f64, normals: &[Vec3], basis: impl Fn(Vec3) -> [Vec3; 2]) {
    let worst = normals.iter().map(|&normal| deviation(normal, basis(normal))).fold(0.0, f64::max);
    println!("| {name} | {double:.2} | {single:.2} | {worst:.1e} |");
}

fn sum([tangent, bitangent]: [Vec3; 2]) -> Vec3 {
    tangent + bitangent
}

/// Nanoseconds a normal in the fastest pass.
fn fastest<T: Copy + std::ops::Add<Output = T> + Default>(normals: &[T], basis: impl Fn(T) -> T) -> f64 {
    let pass = || {
        let start = Instant::now();
        let total = normals.iter().fold(T::default(), |total, &normal| total + basis(black_box(normal)));
        black_box(total);
        start.elapsed().as_secs_f64()
    };
    (0..PASSES).map(|_| pass()).fold(f64::INFINITY, f64::min) / normals.len() as f64 * 1e9
}

/// The largest of all products of two of the three vectors, less 1 for a vector by itself.
fn deviation(normal: Vec3, [tangent, bitangent]: [Vec3; 2]) -> f64 {
    let [n, t, b] = [normal, tangent, bitangent].map(Vec3::as_dvec3);
    [t.dot(t) - 1.0, b.dot(b) - 1.0, n.dot(t), n.dot(b), t.dot(b)].map(f64::abs).into_iter().fold(0.0, f64::max)
}

/// `shaders/core/math.wgsl` has this one.
fn duff(n: Vec3) -> [Vec3; 2] {
    let s = if n.z < -0.2137 { -1.0 } else { 1.0 };
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    [Vec3::new(1.0 + s * n.x * n.x * a, s * b, -s * n.x), Vec3::new(b, s + n.y * n.y * a, -n.y)]
}

fn hughes_moller(n: Vec3) -> [Vec3; 2] {
    let across = if n.x.abs() > n.z.abs() { Vec3::new(-n.y, n.x, 0.0) } else { Vec3::new(0.0, -n.z, n.y) }.normalize();
    [across.cross(n), across]
}

fn hughes_moller_double(n: DVec3) -> [DVec3; 2] {
    let across = if n.x.abs() > n.z.abs() { DVec3::new(-n.y, n.x, 0.0) } else { DVec3::new(0.0, -n.z, n.y) }.normalize();
    [across.cross(n), across]
}
