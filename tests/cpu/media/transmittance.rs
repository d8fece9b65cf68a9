//! Lines through bodies against the equation of transfer, solved step by step.

use crate::common::media::transmittance::{Stretch, radiance, through_box, through_sphere, transmittance};

/// The equation of transfer dL/ds = ε − σ L from the far end to 0, by Runge and Kutta's fourth order between the places where it jumps.
fn stepped(extinction: &dyn Fn(f64) -> f64, emission: &dyn Fn(f64) -> f64, cuts: &[f64], background: f64) -> f64 {
    let mut value = background;
    for pair in cuts.windows(2).rev() {
        let steps = 400;
        let step = (pair[1] - pair[0]) / f64::from(steps);
        let middle = 0.5 * (pair[0] + pair[1]);
        let slope = |value: f64| emission(middle) - extinction(middle) * value;
        for _ in 0..steps {
            let a = slope(value);
            let b = slope(value + 0.5 * step * a);
            let c = slope(value + 0.5 * step * b);
            let d = slope(value + step * c);
            value += step / 6.0 * (a + 2.0 * b + 2.0 * c + d);
        }
    }
    value
}

#[test]
fn lines_through_nested_bodies_obey_the_equation_of_transfer() {
    let outer = Stretch { emission: [0.3, 0.0, 1.0], ..Stretch::new([0.5, 4.0], [0.4, 1.0, 0.0]) };
    let inner = Stretch { emission: [0.0, 2.0, 0.0], ..Stretch::new([1.5, 2.25], [3.0, 0.1, 0.7]) };
    let bodies = [outer, inner];
    let found = radiance(&bodies, 3.5, [1.0, 0.5, 2.0]);
    let cuts = [0.0, 0.5, 1.5, 2.25, 3.5];
    for channel in 0..3 {
        let inside = |place: f64, body: &Stretch| body.from < place && place < body.to;
        let of = |place: f64, value: &dyn Fn(&Stretch) -> f64| {
            let body = if inside(place, &inner) { Some(&inner) } else { inside(place, &outer).then_some(&outer) };
            body.map_or(0.0, value)
        };
        let extinction = |place: f64| of(place, &|body| body.extinction[channel]);
        let emission = |place: f64| of(place, &|body| body.emission[channel]);
        let expected = stepped(&extinction, &emission, &cuts, [1.0, 0.5, 2.0][channel]);
        assert!((found[channel] - expected).abs() < 1e-10, "channel {channel}: {} is not {expected}", found[channel]);
    }
    // The control: the order of the list is the order of nesting.
    assert!((radiance(&[inner, outer], 3.5, [1.0, 0.5, 2.0])[1] - found[1]).abs() > 0.1);
    let through = transmittance(&bodies, 5.0);
    assert!((through[0] - (-(0.4f64 * 2.75 + 3.0 * 0.75)).exp()).abs() < 1e-15, "{through:?}");
}

#[test]
fn lines_meet_spheres_and_boxes() {
    let direction = [0.48, 0.6, 0.64];
    let [near, far] = through_sphere([1.0, -2.0, 0.5], direction, [2.0, -0.5, 1.5], 1.25).expect("it goes through");
    for distance in [near, far] {
        let point: [f64; 3] =
            std::array::from_fn(|axis| [1.0, -2.0, 0.5][axis] + distance * direction[axis] - [2.0, -0.5, 1.5][axis]);
        assert!((point.iter().map(|x| x * x).sum::<f64>().sqrt() - 1.25).abs() < 1e-12);
    }
    assert!(near < far && through_sphere([0.0; 3], direction, [2.0, -2.0, 0.0], 0.5).is_none());
    let [near, far] = through_box([0.0; 3], direction, [0.24, 0.0, 0.0], [1.0, 1.0, 1.0]).expect("it goes through");
    assert!((near - 0.5).abs() < 1e-12 && (far - 1.0 / 0.64).abs() < 1e-12, "{near} {far}");
    assert!(through_box([0.0; 3], direction, [0.0, 1.0, -2.0], [1.0, 2.0, -1.0]).is_none());
}
