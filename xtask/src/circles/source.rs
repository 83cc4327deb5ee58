//! The modules of a crate as far as names go: what each defines, what it imports and what it names by a path.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use syn::visit::{self, Visit};
use syn::{Attribute, Item, UseTree, Visibility};

use super::arrows::Arrows;

/// A path of names.
type Names = Vec<String>;

/// All names of a module.
const ALL: &str = "*";

/// How many hands a name may go through.
const HANDS: usize = 16;

/// A module.
#[derive(Default)]
struct Module {
    file: PathBuf,
    defined: BTreeSet<String>,
    /// What it imports, by the name that it has here.
    imported: BTreeMap<String, Names>,
    /// Modules of which it imports all.
    all_of: Vec<Names>,
    /// What it names by paths, handed on or not.
    named: Vec<Names>,
}

/// The modules of a crate, by their paths.
#[derive(Default)]
pub struct Source(BTreeMap<Names, Module>);

impl Source {
    /// Reads a crate from the file of its root on.
    ///
    /// # Errors
    /// A file that is missing or no Rust.
    pub fn read(top: &Path, read: &dyn Fn(&Path) -> Option<String>) -> Result<Self, String> {
        let mut source = Self::default();
        let folder = top.parent().unwrap_or(top).to_owned();
        source.add_file(Names::new(), top, &folder, read)?;
        Ok(source)
    }

    /// Adds a module that is a file; `folder` holds those of its children.
    fn add_file(
        &mut self,
        module: Names,
        file: &Path,
        folder: &Path,
        read: &dyn Fn(&Path) -> Option<String>,
    ) -> Result<(), String> {
        let text = read(file).ok_or_else(|| format!("{} cannot be read", file.display()))?;
        let items = syn::parse_file(&text)
            .map_err(|e| format!("{}: {e}", file.display()))?
            .items;
        self.add(module, file, folder, &items, read)
    }

    fn add(
        &mut self,
        module: Names,
        file: &Path,
        folder: &Path,
        items: &[Item],
        read: &dyn Fn(&Path) -> Option<String>,
    ) -> Result<(), String> {
        let mut own = Module {
            file: file.to_owned(),
            ..Module::default()
        };
        for item in items {
            match item {
                Item::Mod(it) if !is_of_tests(&it.attrs) => {
                    let child: Names = with(&module, it.ident.to_string());
                    let inner = folder.join(it.ident.to_string());
                    match &it.content {
                        Some((_, items)) => self.add(child, file, &inner, items, read)?,
                        None => {
                            let [beside, inside] =
                                [inner.with_extension("rs"), inner.join("mod.rs")];
                            let file = if read(&beside).is_some() {
                                beside
                            } else {
                                inside
                            };
                            self.add_file(child, &file, &inner, read)?;
                        }
                    }
                }
                Item::Use(it) if !is_of_tests(&it.attrs) => {
                    let handed_on = !matches!(it.vis, Visibility::Inherited);
                    own.import(&Names::new(), &it.tree, handed_on);
                }
                _ => own.visit_item(item),
            }
            own.defined.extend(defined_by(item));
        }
        self.0.insert(module, own);
        Ok(())
    }

    /// Who takes what from whom.
    pub fn arrows(&self) -> Arrows {
        let mut arrows = Arrows::new();
        for (module, own) in &self.0 {
            for path in &own.named {
                let Some((to, name)) = self.resolve(module, path, HANDS) else {
                    continue;
                };
                let to = &self.0[&to].file;
                if *to != own.file {
                    let names = arrows.entry((own.file.clone(), to.clone())).or_default();
                    names.insert(name);
                }
            }
        }
        arrows
    }

    /// The module that defines what a path in a module ends at or goes through, and its name there.
    fn resolve(&self, module: &Names, path: &[String], hands: usize) -> Option<(Names, String)> {
        let hands = hands.checked_sub(1)?;
        let (first, rest) = path.split_first()?;
        let (mut at, mut rest) = match first.as_str() {
            "crate" => (Names::new(), rest),
            "self" => (module.clone(), rest),
            "super" => {
                let (_, parent) = module.split_last()?;
                return self.resolve(&parent.to_vec(), &with_self(rest), hands);
            }
            _ if self.0.contains_key(&with(module, first.clone())) => (module.clone(), path),
            _ => {
                let imported = self.0[module].imported.get(first)?;
                // What is imported by its own name is another crate.
                (imported[0] != *first).then_some(())?;
                return self.resolve(module, &[imported, rest].concat(), hands);
            }
        };
        while let Some((child, more)) = rest.split_first()
            && child == "super"
        {
            at.pop()?;
            rest = more;
        }
        while let Some((child, more)) = rest.split_first()
            && self.0.contains_key(&with(&at, child.clone()))
        {
            at = with(&at, child.clone());
            rest = more;
        }
        let (name, more) = rest.split_first()?;
        let here = self.0.get(&at)?;
        if here.defined.contains(name) || name == ALL {
            return Some((at, name.clone()));
        }
        if let Some(imported) = here.imported.get(name) {
            return self.resolve(&at, &[imported, more].concat(), hands);
        }
        let all_of = here.all_of.iter();
        let mut found = all_of.filter_map(|all| self.resolve(&at, &[all, rest].concat(), hands));
        found.next()
    }
}

impl Module {
    /// Takes up an import.
    fn import(&mut self, before: &[String], tree: &UseTree, handed_on: bool) {
        match tree {
            UseTree::Path(it) => {
                let before = with(before, it.ident.to_string());
                self.import(&before, &it.tree, handed_on);
            }
            UseTree::Group(it) => {
                (it.items.iter()).for_each(|tree| self.import(before, tree, handed_on));
            }
            UseTree::Glob(_) => {
                self.all_of.push(before.to_vec());
                if !handed_on {
                    self.named.push(with(before, ALL.to_owned()));
                }
            }
            UseTree::Name(it) => self.import_as(before, &it.ident, &it.ident, handed_on),
            UseTree::Rename(it) => self.import_as(before, &it.ident, &it.rename, handed_on),
        }
    }

    fn import_as(
        &mut self,
        before: &[String],
        ident: &syn::Ident,
        name: &syn::Ident,
        handed_on: bool,
    ) {
        let path = match ident == "self" {
            true => before.to_vec(),
            false => with(before, ident.to_string()),
        };
        let name = if name == "self" {
            path.last().cloned()
        } else {
            Some(name.to_string())
        };
        if !handed_on {
            self.named.push(path.clone());
        }
        self.imported.extend(name.map(|name| (name, path)));
    }
}

impl Visit<'_> for Module {
    fn visit_path(&mut self, path: &syn::Path) {
        let names: Names = path.segments.iter().map(|s| s.ident.to_string()).collect();
        if names.len() > 1 {
            self.named.push(names);
        }
        visit::visit_path(self, path);
    }

    fn visit_item_use(&mut self, item: &syn::ItemUse) {
        self.import(&[], &item.tree, false);
    }

    fn visit_item_mod(&mut self, _: &syn::ItemMod) {}
}

/// The name that an item defines.
fn defined_by(item: &Item) -> Option<String> {
    let ident = match item {
        Item::Const(it) => &it.ident,
        Item::Enum(it) => &it.ident,
        Item::Fn(it) => &it.sig.ident,
        Item::Macro(it) => it.ident.as_ref()?,
        Item::Static(it) => &it.ident,
        Item::Struct(it) => &it.ident,
        Item::Trait(it) => &it.ident,
        Item::Type(it) => &it.ident,
        Item::Union(it) => &it.ident,
        _ => return None,
    };
    Some(ident.to_string())
}

fn is_of_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute
                .parse_args::<syn::Ident>()
                .is_ok_and(|of| of == "test")
    })
}

fn with(names: &[String], name: String) -> Names {
    [names, &[name]].concat()
}

fn with_self(rest: &[String]) -> Names {
    [&["self".to_owned()], rest].concat()
}
