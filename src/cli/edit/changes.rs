//! Changes of a scene's text: keys are set and left out, entries added, removed, moved and wrapped in blends. Comments, order and spaces of all else
//! stay as they are.

use serde::Deserialize;
use serde_json::{Map, Value as Json};
use toml_edit::{Array, ArrayOfTables, Decor, DocumentMut, InlineTable, Item, Table, TableLike, Value};

use super::values::{assign_table, assign_value, blank_prefix, item_to_json, json_to_value, remove_key, set_key};

/// The lists of a scene that can be changed.
pub const LISTS: [&str; 2] = ["material", "medium"];

/// A key of a table, or an index of a list.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(untagged)]
pub enum Step {
    Index(usize),
    Key(String),
}

/// A change of the text. `at` leads from the scene to what is changed, `["material", 0, "weight", "power"]` say.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "do", rename_all = "lowercase", deny_unknown_fields)]
pub enum Change {
    /// A key or an item has this value from now on.
    Set { at: Vec<Step>, value: Json },
    /// A key is left out, or an item of a list removed.
    Unset { at: Vec<Step> },
    /// An item comes into a list, before the one that has its index.
    Insert { at: Vec<Step>, value: Json },
    /// An item of a list goes to another index.
    Move { at: Vec<Step>, to: usize },
    /// A blend takes the place of a material: of an entry, wherever it is named; of a name in another material, there alone. Both parts of the blend are
    /// what stood there, the second as a copy with a name of its own.
    Wrap { at: Vec<Step> },
}

/// The reason why a change cannot be made: the page asked for what is not there.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Refused(pub &'static str);

const NO_PLACE: Refused = Refused("there is no such place in the scene");
const NO_VALUE: Refused = Refused("that is no value of a scene file");

/// Makes the change.
///
/// # Errors
/// A place that is not there or must not be changed, a value that TOML does not have. The document may be changed in part then.
pub fn apply(document: &mut DocumentMut, change: &Change) -> Result<(), Refused> {
    let (Change::Set { at, .. }
    | Change::Unset { at }
    | Change::Insert { at, .. }
    | Change::Move { at, .. }
    | Change::Wrap { at }) = change;
    let (Some(Step::Key(list)), Some((last, parents))) = (at.first(), at.split_last()) else { return Err(NO_PLACE) };
    if !LISTS.contains(&list.as_str()) || parents.is_empty() {
        return Err(NO_PLACE);
    }
    if let Change::Wrap { .. } = change {
        return wrap(document, at);
    }
    if let (Change::Insert { .. }, [_]) = (change, parents)
        && document.get(list).is_none()
    {
        document.insert(list, Item::ArrayOfTables(ArrayOfTables::new()));
    }
    let parent = place(document, parents).ok_or(NO_PLACE)?;
    match (change, last) {
        (Change::Set { value, .. }, _) => set(parent, last, value),
        (Change::Unset { .. }, _) => unset(parent, last),
        (Change::Insert { value, .. }, Step::Index(index)) => insert(parent, *index, value),
        (Change::Move { to, .. }, Step::Index(index)) => shift(parent, *index, *to),
        _ => Err(NO_PLACE),
    }
}

/// Something in the document.
enum Place<'a> {
    Table(&'a mut dyn TableLike),
    Array(&'a mut Array),
    Tables(&'a mut ArrayOfTables),
}

enum Node<'a> {
    Item(&'a mut Item),
    Table(&'a mut Table),
    Value(&'a mut Value),
}

/// The table or list to which the steps lead.
fn place<'a>(document: &'a mut DocumentMut, steps: &[Step]) -> Option<Place<'a>> {
    let mut node = Node::Table(document.as_table_mut());
    for step in steps {
        node = follow(node, step)?;
    }
    Some(match node {
        Node::Table(table) | Node::Item(Item::Table(table)) => Place::Table(table),
        Node::Item(Item::ArrayOfTables(tables)) => Place::Tables(tables),
        Node::Value(Value::InlineTable(table)) | Node::Item(Item::Value(Value::InlineTable(table))) => Place::Table(table),
        Node::Value(Value::Array(array)) | Node::Item(Item::Value(Value::Array(array))) => Place::Array(array),
        _ => return None,
    })
}

fn follow<'a>(node: Node<'a>, step: &Step) -> Option<Node<'a>> {
    match (node, step) {
        (Node::Item(Item::Value(value)), _) => follow(Node::Value(value), step),
        (Node::Item(Item::Table(table)) | Node::Table(table), Step::Key(key)) => table.get_mut(key).map(Node::Item),
        (Node::Item(Item::ArrayOfTables(tables)), Step::Index(index)) => tables.get_mut(*index).map(Node::Table),
        (Node::Value(Value::InlineTable(table)), Step::Key(key)) => table.get_mut(key).map(Node::Value),
        (Node::Value(Value::Array(array)), Step::Index(index)) => array.get_mut(*index).map(Node::Value),
        _ => None,
    }
}

fn set(parent: Place<'_>, last: &Step, json: &Json) -> Result<(), Refused> {
    let done = match (parent, last) {
        (Place::Table(table), Step::Key(key)) => set_key(table, key, json),
        (Place::Array(array), Step::Index(index)) => assign_value(array.get_mut(*index).ok_or(NO_PLACE)?, json),
        (Place::Tables(tables), Step::Index(index)) => {
            assign_table(tables.get_mut(*index).ok_or(NO_PLACE)?, json.as_object().ok_or(NO_VALUE)?)
        }
        _ => return Err(NO_PLACE),
    };
    done.ok_or(NO_VALUE)
}

fn unset(parent: Place<'_>, last: &Step) -> Result<(), Refused> {
    match (parent, last) {
        (Place::Table(table), Step::Key(key)) if table.contains_key(key) => remove_key(table, key),
        (Place::Array(array), Step::Index(index)) if *index < array.len() => {
            let removed = array.remove(*index);
            let first = array.get_mut(0).filter(|_| *index == 0);
            if let (Some(first), Some(prefix)) = (first, removed.decor().prefix())
                && blank_prefix(first.decor()).is_some()
            {
                first.decor_mut().set_prefix(prefix.clone());
            }
        }
        (Place::Tables(tables), Step::Index(index)) if *index < tables.len() => {
            tables.remove(*index);
        }
        _ => return Err(NO_PLACE),
    }
    Ok(())
}

fn insert(parent: Place<'_>, index: usize, json: &Json) -> Result<(), Refused> {
    match parent {
        Place::Array(array) if index <= array.len() => insert_value(array, index, json_to_value(json).ok_or(NO_VALUE)?),
        Place::Tables(tables) if index <= tables.len() => {
            let mut table = Table::new();
            assign_table(&mut table, json.as_object().ok_or(NO_VALUE)?).ok_or(NO_VALUE)?;
            insert_table(tables, index, table);
        }
        _ => return Err(NO_PLACE),
    }
    Ok(())
}

/// Puts a value into a list as its neighbours stand: on a line of its own, or behind a space.
fn insert_value(array: &mut Array, index: usize, mut value: Value) {
    let neighbour = array.get(index.saturating_sub(1)).or(array.get(0)).map(Value::decor);
    let of_neighbour = neighbour.and_then(blank_prefix).filter(|prefix| prefix.contains('\n'));
    let prefix = of_neighbour.unwrap_or_else(|| if index == 0 { String::new() } else { " ".to_owned() });
    // The space before the bracket stays there.
    let tail = array.get_mut(index.wrapping_sub(1)).filter(|_| index > 0).and_then(|before| {
        let suffix = before.decor().suffix()?.as_str()?.to_owned();
        let is_blank = !suffix.is_empty() && suffix.trim().is_empty();
        is_blank.then(|| before.decor_mut().set_suffix(""))?;
        Some(suffix)
    });
    *value.decor_mut() = Decor::new(prefix, tail.unwrap_or_default());
    array.insert_formatted(index, value);
    if let Some(second) = array.get_mut(1).filter(|_| index == 0)
        && second.decor().prefix().and_then(|prefix| prefix.as_str()).is_some_and(str::is_empty)
    {
        second.decor_mut().set_prefix(" ");
    }
}

/// Puts a table with a head of its own among others, behind an empty line.
fn insert_table(tables: &mut ArrayOfTables, index: usize, mut table: Table) {
    forget_positions(&mut table);
    *table.decor_mut() = Decor::new("\n", "");
    if index == 0 {
        // Before the first one: there the next one finds its own place, which follows.
        table.set_position(tables.get(0).and_then(Table::position));
    }
    tables.insert(index, table);
}

/// Lets a table and those below it stand wherever the ones before them do.
fn forget_positions(table: &mut Table) {
    table.set_position(None);
    for (_, item) in table.iter_mut() {
        match item {
            Item::Table(table) => forget_positions(table),
            Item::ArrayOfTables(tables) => tables.iter_mut().for_each(forget_positions),
            Item::None | Item::Value(_) => {}
        }
    }
}

fn shift(mut parent: Place<'_>, from: usize, to: usize) -> Result<(), Refused> {
    let length = match &parent {
        Place::Array(array) => array.len(),
        Place::Tables(tables) => tables.len(),
        Place::Table(_) => return Err(NO_PLACE),
    };
    if from >= length || to >= length {
        return Err(NO_PLACE);
    }
    let mut index = from;
    while index != to {
        let next = if to > index { index + 1 } else { index - 1 };
        match &mut parent {
            Place::Array(array) => swap_values(array, index.min(next)),
            Place::Tables(tables) => swap_tables(tables, index.min(next)),
            Place::Table(_) => return Err(NO_PLACE),
        }
        index = next;
    }
    Ok(())
}

/// Exchanges an item with the next one. Comments go with their items, spaces stay.
fn swap_values(array: &mut Array, index: usize) {
    let (Some(a), Some(b)) = (array.get(index).cloned(), array.get(index + 1).cloned()) else { return };
    let spaces = [a.decor().clone(), b.decor().clone()];
    let is_blank = |decor: &Decor| {
        [decor.prefix(), decor.suffix()]
            .into_iter()
            .flatten()
            .all(|part| part.as_str().is_some_and(|text| text.trim().is_empty()))
    };
    let stay = spaces.iter().all(is_blank);
    for (place, (mut value, space)) in [index, index + 1].into_iter().zip([b, a].into_iter().zip(spaces)) {
        if stay {
            *value.decor_mut() = space;
        }
        if let Some(slot) = array.get_mut(place) {
            *slot = value;
        }
    }
}

/// Exchanges a table with the next one, where both stand in the text.
fn swap_tables(tables: &mut ArrayOfTables, index: usize) {
    let (Some(mut a), Some(mut b)) = (tables.get(index).cloned(), tables.get(index + 1).cloned()) else { return };
    let positions = [a.position(), b.position()];
    for (place, (table, position)) in [index, index + 1].into_iter().zip([&mut b, &mut a].into_iter().zip(positions)) {
        forget_positions(table);
        table.set_position(position);
        if let Some(slot) = tables.get_mut(place) {
            *slot = table.clone();
        }
    }
}

/// Names of the scene's materials.
fn material_names(document: &DocumentMut) -> Vec<String> {
    let materials = document.get("material").map(item_to_json).unwrap_or_default();
    let names = materials.as_array().into_iter().flatten().filter_map(|entry| entry["name"].as_str());
    names.map(str::to_owned).collect()
}

/// A name like this one that no material has: with another number behind it.
fn free_name(name: &str, taken: &[String]) -> String {
    let stem = name.rsplit_once(' ').filter(|(_, number)| number.parse::<u32>().is_ok()).map_or(name, |(stem, _)| stem);
    let numbered = (1..).map(|number: usize| format!("{stem} {number}"));
    numbered.into_iter().find(|name| !taken.contains(name)).unwrap_or_default()
}

fn wrap(document: &mut DocumentMut, at: &[Step]) -> Result<(), Refused> {
    let mut names = material_names(document);
    let (index, in_place) = match at {
        [Step::Key(list), Step::Index(index)] if list == "material" => (*index, false),
        _ => {
            let (last, parents) = at.split_last().ok_or(NO_PLACE)?;
            let name = match (place(document, parents), last) {
                (Some(Place::Table(table)), Step::Key(key)) => table.get(key).and_then(Item::as_str).map(str::to_owned),
                (Some(Place::Array(array)), Step::Index(index)) => array.get(*index).and_then(Value::as_str).map(str::to_owned),
                _ => None,
            };
            let index = name.and_then(|name| names.iter().position(|one| *one == name));
            (index.ok_or(Refused("no material of this scene file stands there"))?, true)
        }
    };
    let name = names.get(index).cloned().ok_or(NO_PLACE)?;
    let mut take_name = || {
        let free = free_name(&name, &names);
        names.push(free.clone());
        free
    };
    // Every place that names the material names the blend from now on; or the one place that is wrapped does.
    let first = if in_place { name.clone() } else { take_name() };
    let second = take_name();
    let blend = if in_place { take_name() } else { name.clone() };
    let entry = |key: &str, value: Json| (key.to_owned(), value);
    let fields: Map<String, Json> = Map::from_iter([
        entry("name", Json::from(blend.as_str())),
        entry("type", Json::from("blend")),
        entry("materials", Json::from(vec![first.as_str(), second.as_str()])),
        entry("weight", Json::from_iter([("type", Json::from("constant")), ("value", Json::from(0.5))])),
    ]);
    let fields = Json::Object(fields);
    match document.get_mut("material") {
        Some(Item::ArrayOfTables(tables)) => {
            let mut copy = tables.get(index).cloned().ok_or(NO_PLACE)?;
            set_key(&mut copy, "name", &Json::from(second)).ok_or(NO_VALUE)?;
            set_key(tables.get_mut(index).ok_or(NO_PLACE)?, "name", &Json::from(first)).ok_or(NO_VALUE)?;
            insert_table(tables, index + 1, copy);
        }
        Some(Item::Value(Value::Array(array))) => {
            let mut copy = array.get(index).cloned().ok_or(NO_PLACE)?;
            let named = |table: Option<&mut InlineTable>, name: String| {
                set_key(table.ok_or(NO_PLACE)?, "name", &Json::from(name)).ok_or(NO_VALUE)
            };
            named(copy.as_inline_table_mut(), second)?;
            named(array.get_mut(index).and_then(Value::as_inline_table_mut), first)?;
            insert_value(array, index + 1, copy);
        }
        _ => return Err(NO_PLACE),
    }
    let list = [Step::Key("material".to_owned())];
    insert(place(document, &list).ok_or(NO_PLACE)?, index + 2, &fields)?;
    if in_place {
        // Entries behind the wrapped one stand two further.
        let mut at = at.to_vec();
        if let Some(Step::Index(owner)) = at.get_mut(1)
            && *owner > index
        {
            *owner += 2;
        }
        let (last, parents) = at.split_last().ok_or(NO_PLACE)?;
        set(place(document, parents).ok_or(NO_PLACE)?, last, &Json::from(blend))?;
    }
    Ok(())
}
