//! `[[shape]]`

use glam::DAffine3;

use crate::load::file::write_geometry;
use crate::load::file::writer::{Writer, direction, line, number, numbers, vector};
use crate::scene::{MotionStep, Shape, TransformStep};

pub fn shape(shape: &Shape, writer: &mut Writer<'_>) -> String {
    let keys = write_geometry(shape, writer);
    let mut out = format!("\n[[shape]]\ntype = \"{}\"\n{keys}", shape.geometry.kind_name());
    if !shape.transform.steps.is_empty() {
        out += &line("transform", &steps(shape.transform.steps.iter().map(transform_step)));
    }
    if let Some(motion) = &shape.motion {
        out += &line("motion", &steps(motion.steps.iter().map(motion_step)));
    }
    if shape.portal {
        out += &line("portal", "true");
    }
    out
}

fn steps(written: impl Iterator<Item = String>) -> String {
    format!("[{}]", written.collect::<Vec<_>>().join(", "))
}

fn transform_step(step: &TransformStep) -> String {
    match *step {
        TransformStep::Scale(factors) => format!("{{ scale = {} }}", vector(factors)),
        TransformStep::Rotate { axis, degrees } => {
            format!("{{ rotate = {}, degrees = {} }}", direction(axis), number(degrees))
        }
        TransformStep::Translate(offset) => format!("{{ translate = {} }}", vector(offset)),
        TransformStep::Matrix(DAffine3 { matrix3, translation }) => {
            let row = |row: usize| [matrix3.row(row).x, matrix3.row(row).y, matrix3.row(row).z, translation[row]];
            let rows = [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]].concat();
            format!("{{ matrix = {} }}", numbers(&rows))
        }
    }
}

fn motion_step(step: &MotionStep) -> String {
    match *step {
        MotionStep::Scale(factors) => format!("{{ scale = {} }}", vector(factors)),
        MotionStep::Rotate { axis, degrees } | MotionStep::Turned { axis, degrees } => {
            format!("{{ rotate = {}, degrees = {} }}", direction(axis), number(degrees))
        }
        MotionStep::Translate(offset) => format!("{{ translate = {} }}", vector(offset)),
    }
}
