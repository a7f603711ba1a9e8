//! Rules for public names: unique type names, the usual names of constructors, and the field's
//! terms.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};
use syn::{Attribute, Visibility};

/// The folders of the crates.
const CRATES: &[&str] = &[
    "text",
    "memory",
    "kernel",
    "csg",
    "visibility",
    "drawing",
    "exchange",
    "detect",
    "predict",
    "match",
    "verify",
    "premio",
    "cli",
];

/// Words that no public name may contain, with the field's term.
const RETIRED: &[(&str, &str)] = &[
    ("aside", "lateral"),
    ("asked", "queried, requested"),
    ("astray", "systematic offset"),
    ("band", "resolution"),
    ("bands", "resolutions"),
    ("beside", "adjacent"),
    ("crowd", "mark as ambiguous"),
    ("crowded", "ambiguous"),
    ("doubles", "f64"),
    ("doubt", "record as unproven"),
    ("hold", "contain"),
    ("holds", "contains"),
    ("judge", "predicates"),
    ("loose", "tolerance"),
    ("meet", "intersect"),
    ("meets", "intersects"),
    ("met", "hit"),
    ("plain", "simple, unambiguous"),
    ("reckoned", "computed"),
    ("rough", "filter, estimate"),
    ("strand", "contour arc"),
    ("tells", "determines"),
    ("together", "joint"),
    ("told", "determined"),
    ("untold", "undetermined"),
    ("welch", "cycle basis"),
    ("wing", "face use"),
    ("wings", "face uses"),
];

/// The public names of a file.
#[derive(Default)]
struct Names {
    types: Vec<String>,
    /// Types, functions, fields, variants, constants and modules.
    all: Vec<String>,
    /// Associated functions without a receiver.
    constructors: Vec<String>,
}

fn is_public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

fn is_for_tests(attributes: &[Attribute]) -> bool {
    let is_test = |a: &Attribute| {
        let list = a.meta.require_list();
        a.path().is_ident("cfg") && list.is_ok_and(|l| l.tokens.to_string() == "test")
    };
    attributes.iter().any(is_test)
}

impl Names {
    fn new(text: &str) -> Self {
        let mut names = Self::default();
        names.visit_file(&syn::parse_file(text).unwrap());
        names
    }

    fn add(&mut self, visibility: &Visibility, name: &syn::Ident, is_type: bool) {
        if !is_public(visibility) {
            return;
        }
        self.all.push(name.to_string());
        if is_type {
            self.types.push(name.to_string());
        }
    }
}

impl Visit<'_> for Names {
    fn visit_item_mod(&mut self, item: &syn::ItemMod) {
        if !is_for_tests(&item.attrs) {
            self.add(&item.vis, &item.ident, false);
            visit::visit_item_mod(self, item);
        }
    }

    fn visit_item_struct(&mut self, item: &syn::ItemStruct) {
        self.add(&item.vis, &item.ident, true);
        for field in item.fields.iter() {
            if let Some(name) = &field.ident {
                self.add(&field.vis, name, false);
            }
        }
    }

    fn visit_item_enum(&mut self, item: &syn::ItemEnum) {
        self.add(&item.vis, &item.ident, true);
        for variant in &item.variants {
            self.add(&item.vis, &variant.ident, false);
        }
    }

    fn visit_item_trait(&mut self, item: &syn::ItemTrait) {
        self.add(&item.vis, &item.ident, true);
        for part in &item.items {
            if let syn::TraitItem::Fn(function) = part {
                self.add(&item.vis, &function.sig.ident, false);
            }
        }
    }

    fn visit_item_type(&mut self, item: &syn::ItemType) {
        self.add(&item.vis, &item.ident, true);
    }

    fn visit_item_fn(&mut self, item: &syn::ItemFn) {
        self.add(&item.vis, &item.sig.ident, false);
    }

    fn visit_item_const(&mut self, item: &syn::ItemConst) {
        self.add(&item.vis, &item.ident, false);
    }

    fn visit_impl_item_fn(&mut self, item: &syn::ImplItemFn) {
        self.add(&item.vis, &item.sig.ident, false);
        if is_public(&item.vis) && item.sig.receiver().is_none() {
            self.constructors.push(item.sig.ident.to_string());
        }
    }
}

/// The words of a name in snake case, camel case or capitals, in lower case.
fn words(name: &str) -> Vec<String> {
    let mut words = Vec::new();
    for part in name.split('_') {
        let mut word = String::new();
        let mut before = '_';
        for c in part.chars() {
            if c.is_uppercase() && before.is_lowercase() {
                words.push(std::mem::take(&mut word));
            }
            word.extend(c.to_lowercase());
            before = c;
        }
        words.push(word);
    }
    words.retain(|word| !word.is_empty());
    words
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The source files of the crates but for their tests.
fn sources() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders: Vec<PathBuf> = CRATES.iter().map(|c| root().join(c).join("src")).collect();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            match (path.is_dir(), name.as_str()) {
                (true, "tests" | "snapshots") | (false, "tests.rs") => {}
                (true, _) => folders.push(path),
                (false, _) if name.ends_with(".rs") => found.push(path),
                (false, _) => {}
            }
        }
    }
    found.sort();
    assert!(found.len() > 100);
    found
}

fn named() -> Vec<(String, Names)> {
    let relative = |path: &PathBuf| path.strip_prefix(root()).unwrap().display().to_string();
    let read = |path: PathBuf| {
        (
            relative(&path),
            Names::new(&fs::read_to_string(&path).unwrap()),
        )
    };
    sources().into_iter().map(read).collect()
}

#[test]
fn names_are_taken_apart() {
    assert_eq!(words("is_far_off"), ["is", "far", "off"]);
    assert_eq!(words("FaceUse"), ["face", "use"]);
    assert_eq!(words("MAX_LIGHTS"), ["max", "lights"]);
    let names = Names::new(
        "pub struct A { pub told: u8, own: u8 } impl A { pub fn of() {} pub fn to(&self) {} fn x() {} }
         #[cfg(test)] mod tests { pub struct B; }",
    );
    assert_eq!(names.types, ["A"]);
    assert_eq!(names.all, ["A", "told", "of", "to"]);
    assert_eq!(names.constructors, ["of"]);
}

#[test]
fn a_public_type_has_a_name_of_its_own() {
    let mut types: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (path, names) in named() {
        for name in names.types {
            types.entry(name).or_default().push(path.clone());
        }
    }
    types.retain(|_, paths| paths.len() > 1);
    assert!(types.is_empty(), "{types:#?}");
}

#[test]
fn no_constructor_is_called_of() {
    let wrong = named().into_iter();
    let wrong = wrong.filter(|(_, names)| names.constructors.iter().any(|name| name == "of"));
    let wrong: Vec<String> = wrong.map(|(path, _)| path).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn no_public_name_has_a_retired_word() {
    let mut wrong = Vec::new();
    for (path, names) in named() {
        for name in &names.all {
            let words = words(name);
            let retired = RETIRED
                .iter()
                .find(|(word, _)| words.iter().any(|w| w == word));
            if let Some((word, term)) = retired {
                wrong.push(format!("{path}: `{name}` has the word {word}: use {term}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
