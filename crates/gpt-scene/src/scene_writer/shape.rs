//! `[[shape]]`

use glam::{DAffine3, DVec3};

use crate::load::file::writer::{Writer, direction, line, list, number, numbers, table, text, vector};
use crate::load::file::{write_geometry, write_receiver};
use crate::load::{place_rows, write_places};
use crate::scene::{Group, Instances, MotionStep, Shape, TransformStep};

/// More places of instances lie in a file beside the scene file.
const MOST_INLINE_PLACES: usize = 16;

/// A shape under `[[shape]]` or `[[group.shape]]`.
pub fn shape(heading: &str, shape: &Shape, writer: &mut Writer<'_>) -> String {
    let keys = write_geometry(shape, writer);
    let mut out = format!("\n{heading}\n{}{keys}", line("type", &text(shape.geometry.kind_name())));
    if !shape.transform.steps.is_empty() {
        out += &line("transform", &list(shape.transform.steps.iter().map(transform_step)));
    }
    if let Some(motion) = &shape.motion {
        out += &line("motion", &list(motion.steps.iter().map(motion_step)));
    }
    if shape.portal {
        out += &line("portal", "true");
    }
    out + &write_receiver(shape.receiver, writer)
}

/// `[[group]]` with its shapes.
pub fn group(index: usize, group: &Group, writer: &mut Writer<'_>) -> String {
    let name = writer.groups.quoted(index);
    let shapes = group.shapes.iter().map(|of_group| shape("[[group.shape]]", of_group, writer));
    format!("\n[[group]]\n{}{}", line("name", &name), shapes.collect::<String>())
}

/// `[[instance]]`
pub fn instances(instances: &Instances, writer: &mut Writer<'_>) -> String {
    let mut out = format!("\n[[instance]]\n{}", line("group", &writer.groups.quoted(instances.group)));
    match &instances.places[..] {
        [only] if *only == DAffine3::IDENTITY => {}
        few if few.len() <= MOST_INLINE_PLACES => {
            out += &line("places", &list(few.iter().map(|place| numbers(&place_rows(place)))));
        }
        many => {
            let name = format!("places-{}.f64", writer.files.len() + 1);
            out += &line("file", &writer.files.add(&name, write_places(many)));
        }
    }
    if !instances.transform.steps.is_empty() {
        out += &line("transform", &list(instances.transform.steps.iter().map(transform_step)));
    }
    if let Some(material) = instances.material {
        out += &line("material", &writer.materials.quoted(material));
    }
    if let Some(motion) = &instances.motion {
        out += &line("motion", &list(motion.steps.iter().map(motion_step)));
        if let Some(pivot) = instances.pivot {
            out += &line("pivot", &vector(pivot));
        }
    }
    out + &write_receiver(instances.receiver, writer)
}

/// A step of a transform.
pub fn transform_step(step: &TransformStep) -> String {
    match *step {
        TransformStep::Scale(factors) => table([("scale", vector(factors))]),
        TransformStep::Rotate { axis, degrees } => rotation(axis, degrees),
        TransformStep::Translate(offset) => table([("translate", vector(offset))]),
        TransformStep::Matrix(DAffine3 { matrix3, translation }) => {
            let row = |row: usize| [matrix3.row(row).x, matrix3.row(row).y, matrix3.row(row).z, translation[row]];
            let rows = [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]].concat();
            table([("matrix", numbers(&rows))])
        }
    }
}

fn motion_step(step: &MotionStep) -> String {
    match *step {
        MotionStep::Scale(factors) => table([("scale", vector(factors))]),
        MotionStep::Rotate { axis, degrees } | MotionStep::Turned { axis, degrees } => rotation(axis, degrees),
        MotionStep::Translate(offset) => table([("translate", vector(offset))]),
    }
}

fn rotation(axis: DVec3, degrees: f64) -> String {
    table([("rotate", direction(axis)), ("degrees", number(degrees))])
}
