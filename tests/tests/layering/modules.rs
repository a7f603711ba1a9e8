//! The modules of a crate, and the arrows between them: an arrow runs from the module that names an
//! item to the module that defines the item.

use proc_macro2::{TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Attribute, Item, UseTree};

/// A module's path from the crate's root, which is empty.
type ModulePath = Vec<String>;

/// The use of an item of one module by another.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Arrow {
    /// The module that uses the item.
    pub from: ModulePath,
    /// The module that defines the item.
    pub to: ModulePath,
    /// The item as it is written, with its line.
    pub place: String,
}

/// The modules of a crate.
#[derive(Debug, Default)]
pub struct Modules(BTreeMap<ModulePath, Module>);

/// What a module defines and what it names.
#[derive(Debug, Default)]
struct Module {
    /// The names of its items, child modules included.
    items: BTreeSet<String>,
    /// The names that it imports, with their paths.
    imports: BTreeMap<String, Vec<String>>,
    /// The paths of which it imports every name.
    globs: Vec<Vec<String>>,
    /// The paths in its code, with their lines.
    paths: Vec<(usize, Vec<String>)>,
}

impl Modules {
    /// The modules of a crate, without those for tests.
    pub fn read(source: &Path) -> Self {
        let mut modules = Self::default();
        modules.add_file(&source.join("lib.rs"), source, Vec::new());
        modules
    }

    /// The modules of a crate of one file.
    pub fn from_items(items: &[Item]) -> Self {
        let mut modules = Self::default();
        modules.add(items, None, Vec::new());
        modules
    }

    /// Adds a file and the files of its child modules, which are in a folder.
    fn add_file(&mut self, file: &Path, folder: &Path, path: ModulePath) {
        let text = fs::read_to_string(file);
        let text = text.unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let items = syn::parse_file(&text).unwrap().items;
        self.add(&items, Some(folder), path);
    }

    /// Adds a module. The folder is that of its child modules, if these are files.
    fn add(&mut self, items: &[Item], folder: Option<&Path>, path: ModulePath) {
        let mut module = Module::default();
        for item in items.iter().filter(|item| !is_for_tests(attributes(item))) {
            module.items.extend(name(item));
            let Item::Mod(child) = item else {
                module.visit_item(item);
                continue;
            };
            let name = child.ident.to_string();
            let inside: ModulePath = path.iter().cloned().chain([name.clone()]).collect();
            match (&child.content, folder) {
                (Some((_, items)), _) => {
                    let folder = folder.map(|folder| folder.join(&name));
                    self.add(items, folder.as_deref(), inside);
                }
                (None, Some(folder)) => {
                    let children = folder.join(&name);
                    let file = folder.join(format!("{name}.rs"));
                    let file = if file.exists() {
                        file
                    } else {
                        children.join("mod.rs")
                    };
                    self.add_file(&file, &children, inside);
                }
                (None, None) => {}
            }
        }
        self.0.insert(path, module);
    }

    /// The arrows between different modules.
    pub fn arrows(&self) -> Vec<Arrow> {
        let mut arrows = Vec::new();
        for (from, module) in &self.0 {
            // A name alone is an item of the module or an import, unless all names are imported.
            let is_path = |path: &[String]| path.len() > 1 || !module.globs.is_empty();
            for (line, path) in module.paths.iter().filter(|(_, path)| is_path(path)) {
                let to = self.definition(from, path, 0);
                if let Some(to) = to.filter(|to| to != from) {
                    let place = format!("{}:{line} {}", from.join("::"), path.join("::"));
                    let from = from.clone();
                    arrows.push(Arrow { from, to, place });
                }
            }
        }
        arrows
    }

    /// The module that defines what a path in a module names. `None` if it is in another crate.
    fn definition(&self, from: &[String], path: &[String], depth: usize) -> Option<ModulePath> {
        const MAX_REEXPORTS: usize = 16;
        if depth > MAX_REEXPORTS {
            return None;
        }
        let mut at = from.to_vec();
        for (i, name) in path.iter().enumerate() {
            match (i, name.as_str()) {
                (0, "crate") => at.clear(),
                (0, "self") => {}
                (_, "super") => drop(at.pop()?),
                _ => {
                    let child: ModulePath = at.iter().cloned().chain([name.clone()]).collect();
                    let module = &self.0[&at];
                    if self.0.contains_key(&child) {
                        at = child;
                    } else if module.items.contains(name) {
                        return Some(at);
                    } else if let Some(import) = module.imports.get(name) {
                        if *import == path[..=i] {
                            // The crate of this name.
                            return None;
                        }
                        let whole: Vec<String> =
                            import.iter().chain(&path[i + 1..]).cloned().collect();
                        return self.definition(&at, &whole, depth + 1);
                    } else {
                        let all = |glob: &Vec<String>| {
                            let whole: Vec<String> =
                                glob.iter().chain(&path[i..]).cloned().collect();
                            self.definition(&at, &whole, depth + 1)
                        };
                        return module.globs.iter().find_map(all);
                    }
                }
            }
        }
        Some(at)
    }
}

/// Circles between the child modules of one module, each as the arrows of one circle. What a child
/// has in itself counts as the child's.
pub fn circles(arrows: &[Arrow]) -> Vec<Vec<Arrow>> {
    let mut graphs: BTreeMap<&[String], BTreeMap<&str, BTreeMap<&str, &Arrow>>> = BTreeMap::new();
    for arrow in arrows {
        let same = arrow.from.iter().zip(&arrow.to);
        let depth = same.take_while(|(a, b)| a == b).count();
        if let (Some(from), Some(to)) = (arrow.from.get(depth), arrow.to.get(depth)) {
            let graph = graphs.entry(&arrow.from[..depth]).or_default();
            let targets = graph.entry(from).or_default();
            targets.entry(to).or_insert(arrow);
        }
    }
    graphs.values().flat_map(circles_of_siblings).collect()
}

/// The shortest circle through each arrow that closes one.
fn circles_of_siblings(graph: &BTreeMap<&str, BTreeMap<&str, &Arrow>>) -> Vec<Vec<Arrow>> {
    let mut found: BTreeMap<BTreeSet<&str>, Vec<Arrow>> = BTreeMap::new();
    for (&start, targets) in graph {
        for (&first, &arrow) in targets {
            // Breadth first: each module with the arrows that lead to it.
            let mut seen = BTreeSet::from([first]);
            let mut front = vec![(first, vec![arrow], BTreeSet::from([start, first]))];
            let circle = loop {
                let back = |at: &str| graph.get(at).and_then(|to| to.get(start));
                let end = front
                    .iter()
                    .find_map(|(at, way, on)| Some((way, on, *back(at)?)));
                if let Some((way, on, last)) = end {
                    break Some((on.clone(), [&way[..], &[last]].concat()));
                }
                let mut next = Vec::new();
                for (at, way, on) in &front {
                    for (&to, &arrow) in graph.get(at).into_iter().flatten() {
                        if seen.insert(to) {
                            let mut on = on.clone();
                            on.insert(to);
                            next.push((to, [&way[..], &[arrow]].concat(), on));
                        }
                    }
                }
                if next.is_empty() {
                    break None;
                }
                front = next;
            };
            if let Some((on, way)) = circle {
                let arrows = || way.into_iter().cloned().collect();
                found.entry(on).or_insert_with(arrows);
            }
        }
    }
    found.into_values().collect()
}

impl Module {
    fn add_use(&mut self, line: usize, before: &[String], tree: &UseTree) {
        let joined = |name: &syn::Ident| -> Vec<String> {
            let own = (name != "self" || before.is_empty()).then(|| name.to_string());
            before.iter().cloned().chain(own).collect()
        };
        let (path, alias) = match tree {
            UseTree::Path(tree) => return self.add_use(line, &joined(&tree.ident), &tree.tree),
            UseTree::Group(group) => {
                return group
                    .items
                    .iter()
                    .for_each(|tree| self.add_use(line, before, tree));
            }
            UseTree::Glob(_) => {
                self.paths.push((line, before.to_vec()));
                return self.globs.push(before.to_vec());
            }
            UseTree::Name(tree) => {
                let path = joined(&tree.ident);
                let alias = path.last().cloned();
                (path, alias)
            }
            UseTree::Rename(tree) => (joined(&tree.ident), Some(tree.rename.to_string())),
        };
        self.paths.push((line, path.clone()));
        if let Some(alias) = alias {
            self.imports.insert(alias, path);
        }
    }

    /// Adds the paths in the tokens of a macro.
    fn add_tokens(&mut self, tokens: TokenStream) {
        let mut path: Vec<String> = Vec::new();
        let mut colons = 0;
        let mut line = 0;
        for token in tokens {
            match token {
                TokenTree::Punct(punct) if punct.as_char() == ':' => {
                    colons += 1;
                    continue;
                }
                TokenTree::Ident(ident) => {
                    if colons != 2 {
                        self.add_path(line, &mut path);
                        line = ident.span().start().line;
                    }
                    path.push(ident.to_string());
                }
                TokenTree::Group(group) => {
                    self.add_path(line, &mut path);
                    self.add_tokens(group.stream());
                }
                TokenTree::Punct(_) | TokenTree::Literal(_) => self.add_path(line, &mut path),
            }
            colons = 0;
        }
        self.add_path(line, &mut path);
    }

    fn add_path(&mut self, line: usize, path: &mut Vec<String>) {
        let path = std::mem::take(path);
        if !path.is_empty() {
            self.paths.push((line, path));
        }
    }
}

impl Visit<'_> for Module {
    fn visit_item_use(&mut self, item: &syn::ItemUse) {
        self.add_use(item.span().start().line, &[], &item.tree);
    }

    fn visit_path(&mut self, path: &syn::Path) {
        let mut names = path.segments.iter().map(|s| s.ident.to_string()).collect();
        self.add_path(path.span().start().line, &mut names);
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, item: &syn::Macro) {
        self.add_tokens(item.tokens.clone());
        visit::visit_macro(self, item);
    }

    fn visit_impl_item_fn(&mut self, item: &syn::ImplItemFn) {
        if !is_for_tests(&item.attrs) {
            visit::visit_impl_item_fn(self, item);
        }
    }
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// The name that an item defines.
fn name(item: &Item) -> Option<String> {
    let name = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Mod(item) => &item.ident,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::Type(item) => &item.ident,
        Item::Macro(item) => item.ident.as_ref()?,
        _ => return None,
    };
    Some(name.to_string())
}

fn is_for_tests(attributes: &[Attribute]) -> bool {
    let is_test = |attribute: &Attribute| {
        attribute.path().is_ident("cfg")
            && attribute
                .parse_args::<syn::Path>()
                .is_ok_and(|path| path.is_ident("test"))
    };
    attributes.iter().any(is_test)
}
