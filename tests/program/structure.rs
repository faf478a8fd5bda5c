//! Imports within each crate: without cycles among files or sibling folders.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use petgraph::algo::tarjan_scc;
use petgraph::graphmap::DiGraphMap;
use syn::visit::Visit;
use syn::{Attribute, Item, UseTree};

/// The crates' first files.
const CRATES: [&str; 8] = [
    "src/tiles/lib.rs",
    "src/landscape/lib.rs",
    "src/shaken/lib.rs",
    "src/words/lib.rs",
    "src/jobs/lib.rs",
    "src/report/lib.rs",
    "src/main.rs",
    "src/python/rust/lib.rs",
];

/// A full name within the crate: of a module, or of an item in one.
type Name = Vec<String>;

/// A file of a crate: the names of its own crate that it uses, and those that it re-exports.
struct Module {
    named: BTreeSet<Name>,
    known_as: BTreeMap<String, Name>,
}

/// Collects every name in a file, except in its tests.
struct Reader {
    module: Name,
    children: BTreeSet<String>,
    imports: Vec<(Name, String)>,
    paths: Vec<Name>,
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let list = attribute.meta.require_list();
        attribute.path().is_ident("cfg") && list.is_ok_and(|l| l.tokens.to_string() == "test")
    })
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Mod(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        _ => &[],
    }
}

impl Reader {
    fn import(&mut self, prefix: &[String], tree: &UseTree) {
        let with = |name: &syn::Ident| [prefix, &[name.to_string()]].concat();
        match tree {
            UseTree::Path(path) => self.import(&with(&path.ident), &path.tree),
            UseTree::Name(name) if name.ident == "self" => {
                let last = prefix.last().expect("of something").clone();
                self.imports.push((prefix.to_vec(), last));
            }
            UseTree::Name(name) => self
                .imports
                .push((with(&name.ident), name.ident.to_string())),
            UseTree::Rename(name) => {
                self.imports
                    .push((with(&name.ident), name.rename.to_string()));
            }
            UseTree::Glob(_) => self.paths.push(prefix.to_vec()),
            UseTree::Group(group) => group
                .items
                .iter()
                .for_each(|tree| self.import(prefix, tree)),
        }
    }

    /// A path as a full name, if it is in the crate.
    fn absolute(&self, path: &[String]) -> Option<Name> {
        let mut top = match path[0].as_str() {
            "crate" => Vec::new(),
            "self" | "super" => self.module.clone(),
            name if self.children.contains(name) => {
                return Some([&self.module, path].concat());
            }
            name => {
                let mut imports = self.imports.iter();
                let (import, _) = imports.find(|(import, known)| {
                    known == name && ["crate", "self", "super"].contains(&import[0].as_str())
                })?;
                return self.absolute(&[import, &path[1..]].concat());
            }
        };
        for name in path {
            match name.as_str() {
                "crate" | "self" => {}
                "super" => drop(top.pop()),
                _ => top.push(name.clone()),
            }
        }
        Some(top)
    }
}

impl<'a> Visit<'a> for Reader {
    fn visit_item(&mut self, item: &'a Item) {
        if !is_test(attributes(item)) {
            syn::visit::visit_item(self, item);
        }
    }

    fn visit_item_mod(&mut self, module: &'a syn::ItemMod) {
        if module.content.is_none() {
            self.children.insert(module.ident.to_string());
        }
        syn::visit::visit_item_mod(self, module);
    }

    fn visit_item_use(&mut self, item: &'a syn::ItemUse) {
        self.import(&[], &item.tree);
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        self.paths
            .push(path.segments.iter().map(|s| s.ident.to_string()).collect());
        syn::visit::visit_path(self, path);
    }
}

/// Reads a module's file and those of its children; `folder` is where the children's files are.
fn read(module: Name, file: &Path, folder: &Path, modules: &mut BTreeMap<Name, Module>) {
    let text = fs::read_to_string(file).unwrap();
    let mut reader = Reader {
        module: module.clone(),
        children: BTreeSet::new(),
        imports: Vec::new(),
        paths: Vec::new(),
    };
    let parsed = syn::parse_file(&text);
    reader.visit_file(&parsed.unwrap_or_else(|why| panic!("{}: {why}", file.display())));
    for child in reader.children.clone() {
        let [alone, front] =
            [format!("{child}.rs"), format!("{child}/mod.rs")].map(|f| folder.join(f));
        let file = if alone.exists() { alone } else { front };
        let name = [module.clone(), vec![child.clone()]].concat();
        read(name, &file, &folder.join(child), modules);
    }
    let paths = reader
        .paths
        .iter()
        .chain(reader.imports.iter().map(|(import, _)| import));
    let named = paths.filter_map(|path| reader.absolute(path)).collect();
    let imports = reader.imports.iter();
    let known_as = imports
        .filter_map(|(import, known)| Some((known.clone(), reader.absolute(import)?)))
        .collect();
    modules.insert(module, Module { named, known_as });
}

/// The module in which something is defined: the one in its name, or the one that this re-exports
/// it from.
fn defined_in<'a>(name: &[String], modules: &'a BTreeMap<Name, Module>) -> &'a Name {
    let lengths = (0..=name.len()).rev();
    let mut found = lengths.filter_map(|n| modules.get_key_value(&name[..n]).map(|m| (n, m)));
    let (n, (module, content)) = found.next().expect("the crate's top is a module");
    let item = name.get(n).and_then(|item| content.known_as.get(item));
    match item {
        Some(origin) if origin[..] != name[..=n] => defined_in(origin, modules),
        _ => module,
    }
}

/// Cycles among sibling modules of a crate, each a file or a folder with all its files; without these
/// there are none among files. A folder's files may use definitions in its `mod.rs`.
fn circles(first: &str) -> Vec<Vec<String>> {
    let first = Path::new(env!("CARGO_MANIFEST_DIR")).join(first);
    let mut modules = BTreeMap::new();
    read(Vec::new(), &first, first.parent().unwrap(), &mut modules);
    let mut imports = DiGraphMap::<&[String], ()>::new();
    for (name, module) in &modules {
        for named in module
            .named
            .iter()
            .filter(|named| !modules.contains_key(*named))
        {
            let from = defined_in(named, &modules);
            let common = name.iter().zip(from).take_while(|(a, b)| a == b).count();
            if common < name.len().min(from.len()) {
                imports.add_edge(&name[..=common], &from[..=common], ());
            }
        }
    }
    let circles = tarjan_scc(&imports)
        .into_iter()
        .filter(|siblings| siblings.len() > 1);
    circles
        .map(|siblings| siblings.into_iter().map(|it| it.join("::")).collect())
        .collect()
}

#[test]
fn neither_files_nor_folders_import_each_other_in_circles() {
    let found: Vec<_> = CRATES.into_iter().flat_map(circles).collect();
    assert!(found.is_empty(), "{found:#?}");
}
