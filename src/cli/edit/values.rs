//! Values of TOML as JSON and back. A value that is replaced keeps the spaces and comments around it, and a number that stays as it is keeps its digits.

use serde_json::{Map, Number, Value as Json};
use toml_edit::{Array, Decor, InlineTable, Item, RawString, TableLike, Value};

/// A value as JSON; a number that is not finite as null, a date as a text.
pub fn value_to_json(value: &Value) -> Json {
    match value {
        Value::String(text) => Json::String(text.value().clone()),
        Value::Integer(number) => Json::from(*number.value()),
        Value::Float(number) => Number::from_f64(*number.value()).map_or(Json::Null, Json::Number),
        Value::Boolean(flag) => Json::Bool(*flag.value()),
        Value::Datetime(time) => Json::String(time.value().to_string()),
        Value::Array(array) => Json::Array(array.iter().map(value_to_json).collect()),
        Value::InlineTable(table) => table_to_json(table),
    }
}

/// A table, its keys in their order.
pub fn table_to_json(table: &dyn TableLike) -> Json {
    Json::Object(table.iter().map(|(key, item)| (key.to_owned(), item_to_json(item))).collect())
}

/// An item as JSON; null where there is none.
pub fn item_to_json(item: &Item) -> Json {
    match item {
        Item::None => Json::Null,
        Item::Value(value) => value_to_json(value),
        Item::Table(table) => table_to_json(table),
        Item::ArrayOfTables(tables) => Json::Array(tables.iter().map(|table| table_to_json(table)).collect()),
    }
}

/// A value of JSON in the form that TOML has by default; None where there is a null in it, or a number that TOML does not have.
pub fn json_to_value(json: &Json) -> Option<Value> {
    Some(match json {
        Json::Null => return None,
        Json::Bool(flag) => Value::from(*flag),
        Json::String(text) => Value::from(text.as_str()),
        Json::Number(number) => match number.as_i64() {
            Some(whole) => Value::from(whole),
            None => Value::from(number.as_f64().filter(|number| number.is_finite())?),
        },
        Json::Array(items) => Value::Array(items.iter().map(json_to_value).collect::<Option<Array>>()?),
        Json::Object(fields) => {
            let mut table = InlineTable::new();
            for (key, json) in fields {
                table.insert(key, json_to_value(json)?);
            }
            Value::InlineTable(table)
        }
    })
}

/// True where both say the same, whether or not a number is written as a whole one.
fn is_same(a: &Json, b: &Json) -> bool {
    match (a, b) {
        (Json::Number(a), Json::Number(b)) => a.as_f64() == b.as_f64(),
        (Json::Array(a), Json::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| is_same(a, b)),
        (Json::Object(a), Json::Object(b)) => {
            a.len() == b.len() && a.iter().all(|(key, a)| b.get(key).is_some_and(|b| is_same(a, b)))
        }
        _ => a == b,
    }
}

/// Puts a value in the place of another one. None as for [`json_to_value`].
pub fn assign_value(value: &mut Value, json: &Json) -> Option<()> {
    if is_same(&value_to_json(value), json) {
        return Some(());
    }
    match (&mut *value, json) {
        (Value::Array(array), Json::Array(items)) if array.len() == items.len() => {
            return array.iter_mut().zip(items).try_for_each(|(value, json)| assign_value(value, json));
        }
        (Value::InlineTable(table), Json::Object(fields)) => return assign_table(table, fields),
        _ => {}
    }
    let new = match (&*value, json) {
        // A number with a point keeps one.
        (Value::Float(_), Json::Number(number)) => Value::from(number.as_f64().filter(|number| number.is_finite())?),
        _ => json_to_value(json)?,
    };
    let decor = value.decor().clone();
    *value = new;
    *value.decor_mut() = decor;
    Some(())
}

/// Does the work of [`assign_value`] for what may be a table with a head of its own.
pub fn assign_item(item: &mut Item, json: &Json) -> Option<()> {
    match (&mut *item, json) {
        (Item::Value(value), _) => assign_value(value, json),
        (Item::Table(table), Json::Object(fields)) => assign_table(table, fields),
        (other, _) if is_same(&item_to_json(other), json) => Some(()),
        _ => {
            *item = Item::Value(json_to_value(json)?);
            Some(())
        }
    }
}

/// Gives a table these keys and no others.
pub fn assign_table(table: &mut dyn TableLike, fields: &Map<String, Json>) -> Option<()> {
    let gone: Vec<String> = table.iter().map(|(key, _)| key.to_owned()).filter(|key| !fields.contains_key(key)).collect();
    for (key, json) in fields {
        set_key(table, key, json)?;
    }
    gone.iter().for_each(|key| remove_key(table, key));
    Some(())
}

/// Gives a key of a table a value; a new key stands last, on a line of its own where the others do.
pub fn set_key(table: &mut dyn TableLike, key: &str, json: &Json) -> Option<()> {
    if let Some(item) = table.get_mut(key) {
        return assign_item(item, json);
    }
    let value = json_to_value(json)?;
    let before = table.iter().last().map(|(key, _)| key.to_owned());
    let indent = before.as_deref().and_then(|before| blank_prefix(table.key(before)?.leaf_decor()));
    let tail = before.as_deref().and_then(|before| take_tail(table, before));
    table.insert(key, Item::Value(value));
    if let (Some(indent), Some(mut key)) = (indent.filter(|indent| indent.contains('\n')), table.key_mut(key)) {
        key.leaf_decor_mut().set_prefix(indent);
    }
    if let (Some(tail), Some(value)) = (tail, table.get_mut(key).and_then(Item::as_value_mut)) {
        value.decor_mut().set_suffix(tail);
    }
    Some(())
}

/// Removes a key with the comment that stands before it.
pub fn remove_key(table: &mut dyn TableLike, key: &str) {
    let is_last = table.iter().last().is_some_and(|(last, _)| last == key);
    let tail = if is_last { take_tail(table, key) } else { None };
    table.remove(key);
    let last = table.iter().last().map(|(key, _)| key.to_owned());
    let last = last.and_then(|last| table.get_mut(&last)).and_then(Item::as_value_mut);
    if let (Some(tail), Some(value)) = (tail, last) {
        value.decor_mut().set_suffix(tail);
    }
}

/// Takes the space before the brace that closes an inline table from its last value; of a table with a head, nothing, for comments stand there.
fn take_tail(table: &mut dyn TableLike, last: &str) -> Option<RawString> {
    let value = table.get_mut(last)?.as_value_mut()?;
    let suffix = value.decor().suffix()?.clone();
    let is_blank = suffix.as_str().is_some_and(|text| !text.is_empty() && text.trim().is_empty());
    if !is_blank {
        return None;
    }
    value.decor_mut().set_suffix("");
    Some(suffix)
}

/// Space before something, without comments and without empty lines.
pub fn blank_prefix(decor: &Decor) -> Option<String> {
    let prefix = decor.prefix()?.as_str()?;
    let start = prefix.rfind('\n').unwrap_or(0);
    let blank = &prefix[start..];
    blank.trim().is_empty().then(|| blank.to_owned())
}
