//! Tables of things that a scene refers to by name, before or after their definition.

use crate::scene::desc::Id;
use crate::scene::source::Span;
use crate::scene::text::Text;
use std::collections::HashMap;

/// Things of one kind, some of them named. An id is given out at the first mention of a name.
#[derive(Debug)]
pub(super) struct Table<T> {
    ids: HashMap<String, u32>,
    entries: Vec<Entry<T>>,
}

#[derive(Debug)]
struct Entry<T> {
    name: Option<String>,
    value: Option<T>,
    /// The definition, or the first mention while there is none.
    span: Option<Span>,
    defined: bool,
}

impl<T> Default for Table<T> {
    fn default() -> Self {
        Self { ids: HashMap::new(), entries: Vec::new() }
    }
}

impl<T> Table<T> {
    /// Adds a thing without a name.
    pub(super) fn push(&mut self, value: T) -> Id<T> {
        self.entries.push(Entry { name: None, value: Some(value), span: None, defined: true });
        Id::new((self.entries.len() - 1) as u32)
    }

    /// The id of a name, which need not be defined yet.
    pub(super) fn refer(&mut self, name: &Text) -> Id<T> {
        if let Some(&id) = self.ids.get(&name.value) {
            return Id::new(id);
        }
        let id = self.entries.len() as u32;
        let named = Some(name.value.clone());
        self.entries.push(Entry { name: named, value: None, span: Some(name.span), defined: false });
        self.ids.insert(name.value.clone(), id);
        Id::new(id)
    }

    /// Marks a name as defined here; its value follows by [`Table::set`]. `Err` has the place of an earlier definition.
    pub(super) fn define(&mut self, name: &Text) -> Result<Id<T>, Span> {
        let id = self.refer(name);
        let e = &mut self.entries[id.index()];
        if e.defined {
            return Err(e.span.unwrap_or(name.span));
        }
        e.defined = true;
        e.span = Some(name.span);
        Ok(id)
    }

    /// Gives the value of a defined name.
    pub(super) fn set(&mut self, id: Id<T>, value: T) {
        self.entries[id.index()].value = Some(value);
    }

    /// The value of an id; `None` while it has none.
    pub(super) fn get(&self, id: Id<T>) -> Option<&T> {
        self.entries.get(id.index())?.value.as_ref()
    }

    /// Names that were mentioned and never defined, with their first mention.
    pub(super) fn undefined(&self) -> impl Iterator<Item = (&str, Span)> {
        self.entries.iter().filter(|e| !e.defined).filter_map(|e| Some((e.name.as_deref()?, e.span?)))
    }

    /// Names that were defined.
    pub(super) fn defined_names(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().filter(|e| e.defined).filter_map(|e| e.name.as_deref())
    }

    /// Number of ids given out.
    pub(super) fn len(&self) -> usize {
        self.entries.len()
    }

    /// The values by id; `None` unless every one is there.
    pub(super) fn into_values(self) -> Option<Vec<T>> {
        self.entries.into_iter().map(|e| e.value).collect()
    }
}
