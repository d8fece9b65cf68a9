//! KHR_materials_variants: materials that take the place of others, all at once.

use serde_json::Value;

use super::json::{Primitive, Root};
use crate::load::printable::short_list;

const NAME: &str = "KHR_materials_variants";

/// The names of the file's variants.
pub fn names(root: &Root) -> Vec<String> {
    let variants = root.extensions.get(NAME).and_then(|extension| extension.get("variants")).and_then(Value::as_array);
    let name = |variant: &Value| variant.get("name").and_then(Value::as_str).unwrap_or_default().to_owned();
    variants.into_iter().flatten().map(name).collect()
}

/// The place of the wanted variant among them.
pub fn chosen(root: &Root, wanted: Option<&str>) -> Result<Option<usize>, String> {
    let Some(wanted) = wanted else { return Ok(None) };
    let names = names(root);
    let place = names.iter().position(|name| name == wanted);
    place.map(Some).ok_or_else(|| match names.is_empty() {
        true => format!("there is no variant `{wanted}`: the file has none"),
        false => format!("there is no variant `{wanted}`, but {}", short_list(&names)),
    })
}

/// The material of a primitive where variant number `shown` is, if any is.
pub fn material_of(shown: Option<usize>, primitive: &Primitive) -> Option<usize> {
    let of_variant = || {
        let shown = shown? as u64;
        let mappings = primitive.extensions.get(NAME)?.get("mappings")?.as_array()?;
        let is_of_it = |mapping: &&Value| {
            let variants = mapping.get("variants").and_then(Value::as_array);
            variants.into_iter().flatten().any(|variant| variant.as_u64() == Some(shown))
        };
        Some(mappings.iter().find(is_of_it)?.get("material")?.as_u64()? as usize)
    };
    of_variant().or(primitive.material)
}
