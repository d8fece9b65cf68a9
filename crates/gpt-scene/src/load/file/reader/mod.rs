//! Reads the types of a scene file from the tree of its text, through serde.
//!
//! A table whose kind is said by a key, `{ type = "mirror", … }`, is an enum with one struct per kind. Serde would read such an enum through a
//! buffer that forgets where things were written; here the key is looked up first, and the struct is read from the rest. Lists are never taken
//! for tables, and mistakes carry the place of the innermost value around them.

mod located;
mod mistake;
mod tree;

pub use located::located;
pub use mistake::Mistake;
pub use tree::{Node, mistakes, read};
