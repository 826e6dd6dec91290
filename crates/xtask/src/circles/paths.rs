//! The paths that a module names, in its `use`s, its code and its macros.

use proc_macro2::{TokenStream, TokenTree};
use std::collections::BTreeSet;
use syn::visit::{self, Visit};
use syn::{Attribute, Item, Meta, UseTree};

/// The paths of a module. Those that begin with `::` lead to other crates and are left out.
#[derive(Default)]
pub struct Paths {
    /// What the `use`s bring into the module: the name here, and the path.
    pub imports: Vec<(String, Vec<String>)>,
    /// The paths of the `use`s that end in `*`.
    pub globs: Vec<Vec<String>>,
    /// All paths that the module names.
    pub named: BTreeSet<Vec<String>>,
}

impl Paths {
    /// Adds the paths of an item.
    pub fn read(&mut self, item: &Item) {
        self.visit_item(item);
    }

    /// Adds a path in code. A lower-case name alone may be a variable; if it is not, a `use` names
    /// it as well.
    fn name(&mut self, path: Vec<String>) {
        if path.len() > 1 || path.first().is_some_and(|name| name.starts_with(char::is_uppercase)) {
            self.named.insert(path);
        }
    }

    fn tree(&mut self, tree: &UseTree, mut path: Vec<String>) {
        let (name, own) = match tree {
            UseTree::Path(inner) => {
                path.push(inner.ident.to_string());
                return self.tree(&inner.tree, path);
            }
            UseTree::Group(group) => {
                return group.items.iter().for_each(|tree| self.tree(tree, path.clone()));
            }
            UseTree::Glob(_) => {
                self.named.insert(path.clone());
                return self.globs.push(path);
            }
            UseTree::Name(name) => (name.ident.to_string(), name.ident.to_string()),
            UseTree::Rename(name) => (name.ident.to_string(), name.rename.to_string()),
        };
        let own = if own == "self" { path.last().cloned().unwrap_or_default() } else { own };
        if name != "self" {
            path.push(name);
        }
        self.named.insert(path.clone());
        self.imports.push((own, path));
    }

    /// The paths in a macro, of which nothing but the tokens is known.
    fn tokens(&mut self, tokens: TokenStream) {
        let (mut path, mut colons): (Vec<String>, usize) = (Vec::new(), 0);
        for token in tokens {
            match token {
                TokenTree::Punct(punct) if punct.as_char() == ':' => colons += 1,
                TokenTree::Ident(name) if colons == 2 && !path.is_empty() => {
                    path.push(name.to_string());
                    colons = 0;
                }
                other => {
                    self.name(std::mem::take(&mut path));
                    colons = 0;
                    match other {
                        TokenTree::Ident(name) => path.push(name.to_string()),
                        TokenTree::Group(group) => self.tokens(group.stream()),
                        TokenTree::Punct(_) | TokenTree::Literal(_) => {}
                    }
                }
            }
        }
        self.name(path);
    }
}

impl<'a> Visit<'a> for Paths {
    fn visit_item(&mut self, item: &'a Item) {
        let attributes = match item {
            Item::Use(item) => &item.attrs,
            Item::Fn(item) => &item.attrs,
            Item::Impl(item) => &item.attrs,
            _ => return visit::visit_item(self, item),
        };
        if !is_for_tests(attributes) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'a syn::ItemUse) {
        if item.leading_colon.is_none() {
            self.tree(&item.tree, Vec::new());
        }
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        if path.leading_colon.is_none() {
            self.name(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, item: &'a syn::Macro) {
        self.tokens(item.tokens.clone());
        visit::visit_macro(self, item);
    }
}

/// Whether an item is only compiled for tests.
pub fn is_for_tests(attributes: &[Attribute]) -> bool {
    let tests = |attribute: &Attribute| match &attribute.meta {
        Meta::List(list) => list.path.is_ident("cfg") && list.tokens.to_string() == "test",
        _ => false,
    };
    attributes.iter().any(tests)
}
