//! Code that decides never compares f64 values by operators: it uses `kernel::number::predicates`.
//!
//! The sources are parsed, but types are not known here. An order (`<`, `>=`) counts as one of f64
//! values unless a side shows that it is of integers; an equality counts if a side shows it. The
//! following are therefore missed: an equality of two simple names, or of arrays and structures of
//! f64 values; an order of two f64 values one of which is named like an integer; and comparisons in
//! a macro whose body is neither a list of expressions nor that of `matches!`.

use std::fs;
use std::path::{Path, PathBuf};
use syn::parse::{ParseStream, Parser};
use syn::punctuated::Punctuated;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{BinOp, Expr, Lit, Token};

/// The sources of the stages from numbers to boundaries and views.
const SOURCES: &[&str] = &["kernel/src", "csg/src", "visibility/src"];

/// The files in which f64 values may be compared, with the reasons.
const EXCEPTIONS: &[(&str, &str)] = &[
    (
        "kernel/src/number",
        "the predicates themselves, and arithmetic",
    ),
    (
        "kernel/src/geometry",
        "constructions propose, and never decide",
    ),
    (
        "kernel/src/random.rs",
        "random numbers, on which no result depends",
    ),
    (
        "kernel/src/proof",
        "proofs compare integers, and bounds of their size",
    ),
    (
        "kernel/src/tessellation",
        "meshes serve for display and for checks only",
    ),
    (
        "csg/src/ray_casting",
        "a measurement on which no result depends",
    ),
    (
        "csg/src/drawing_file",
        "exact numbers, and the validity of a text",
    ),
    (
        "kernel/src/colour.rs",
        "colours, on which no boundary depends",
    ),
    (
        "csg/src/evaluate/face_colours.rs",
        "colours, on which no boundary depends",
    ),
    (
        "csg/src/builder/unbounded",
        "a box around the part with margins, and exact numbers",
    ),
    ("csg/src/reader", "the validity of a text"),
    ("csg/src/writer", "the notation of numbers"),
    (
        "csg/src/recover",
        "the rounding of written coordinates, before anything is intersected",
    ),
    ("csg/src/primitive.rs", "the validity of lengths"),
    (
        "csg/src/figure",
        "exact numbers behind a filter with an error bound, and the validity of a description",
    ),
    (
        "csg/src/polyhedron",
        "exact numbers behind a filter with an error bound, and the validity of a description",
    ),
    (
        "csg/src/construction",
        "exact numbers, before anything is intersected",
    ),
    ("drawing/src", "drawing after all decisions"),
];

/// Calls that return integers.
const WHOLE_CALLS: &[&str] = &["len", "count", "index", "degree", "bits", "side_count"];

/// Names that always denote integers.
const WHOLE_NAMES: &[&str] = &[
    "i",
    "j",
    "k",
    "bits",
    "data",
    "depth",
    "entities",
    "junction",
    "leaves",
    "quantitative_invisibility",
];

/// Types that their constructors identify, and that are not f64.
const WHOLE_TYPES: &[&str] = &[
    "usize", "isize", "u64", "i64", "u32", "i32", "u8", "Rational",
];

/// Constants of type f64 or wider.
const CONSTANTS: &[&str] = &[
    "ZERO",
    "HALF",
    "ONE",
    "TWO",
    "PI",
    "TAU",
    "EPSILON",
    "ROUNDING",
    "INFINITY",
    "NEG_INFINITY",
    "NAN",
];

/// Calls that return f64 values.
const CALLS: &[&str] = &[
    "dot",
    "length",
    "norm",
    "hypot",
    "distance",
    "signum",
    "sqrt",
    "sin",
    "cos",
    "resolution",
    "reach",
    "rounded",
];

/// Calls that compare; `contains` of a range does as well.
const COMPARING: &[&str] = &[
    "partial_cmp",
    "lt",
    "le",
    "gt",
    "ge",
    "is_lt",
    "is_le",
    "is_gt",
    "is_ge",
    "is_sign_positive",
    "is_sign_negative",
];

/// The expression without parentheses, references and signs.
fn bare(e: &Expr) -> &Expr {
    match e {
        Expr::Paren(e) => bare(&e.expr),
        Expr::Group(e) => bare(&e.expr),
        Expr::Reference(e) => bare(&e.expr),
        Expr::Unary(e) => bare(&e.expr),
        e => e,
    }
}

/// The segments of a path.
fn names(path: &syn::Path) -> Vec<String> {
    path.segments.iter().map(|s| s.ident.to_string()).collect()
}

fn is_one_of(list: &[&str], name: impl ToString) -> bool {
    list.contains(&name.to_string().as_str())
}

/// Whether an expression is evidently of integers, or of other exact values.
fn is_whole(e: &Expr) -> bool {
    match bare(e) {
        Expr::Lit(e) => matches!(e.lit, Lit::Int(_)),
        Expr::Binary(e) => is_whole(&e.left) || is_whole(&e.right),
        Expr::MethodCall(e) => is_one_of(WHOLE_CALLS, &e.method) || yields_whole(e),
        Expr::Index(e) => matches!(bare(&e.expr), Expr::Field(_)) && is_whole(&e.expr),
        Expr::Field(e) => match &e.member {
            syn::Member::Named(name) => is_one_of(WHOLE_NAMES, name),
            syn::Member::Unnamed(_) => false,
        },
        Expr::Path(e) => match &names(&e.path)[..] {
            [name] => is_one_of(WHOLE_NAMES, name),
            [kind, ..] => is_one_of(WHOLE_TYPES, kind),
            [] => false,
        },
        Expr::Call(e) => is_whole(&e.func),
        Expr::Cast(e) => match &*e.ty {
            syn::Type::Path(e) => names(&e.path).iter().any(|n| is_one_of(WHOLE_TYPES, n)),
            _ => false,
        },
        _ => false,
    }
}

/// Whether a call names an integer as the type of what it gives: `sum::<usize>()`.
fn yields_whole(call: &syn::ExprMethodCall) -> bool {
    let arguments = call.turbofish.iter().flat_map(|turbofish| &turbofish.args);
    arguments.into_iter().any(|argument| match argument {
        syn::GenericArgument::Type(syn::Type::Path(e)) => {
            names(&e.path).iter().any(|n| is_one_of(WHOLE_TYPES, n))
        }
        _ => false,
    })
}

/// Whether an expression is evidently an f64 or wider.
fn is_double(e: &Expr) -> bool {
    match bare(e) {
        Expr::Lit(e) => matches!(e.lit, Lit::Float(_)),
        Expr::Binary(e) => is_double(&e.left) || is_double(&e.right),
        Expr::MethodCall(e) => is_one_of(CALLS, &e.method),
        Expr::Path(e) => match &names(&e.path)[..] {
            [kind, ..] if is_one_of(WHOLE_TYPES, kind) => false,
            [.., name] => is_one_of(CONSTANTS, name),
            [] => false,
        },
        // `Some(0.0)`, `N::of(x)`.
        Expr::Call(e) => match bare(&e.func) {
            Expr::Path(f) if names(&f.path).last().is_some_and(|n| n == "of") => true,
            _ => e.args.iter().any(is_double),
        },
        Expr::Cast(e) => matches!(&*e.ty, syn::Type::Path(e) if e.path.is_ident("f64")),
        Expr::Array(e) => e.elems.iter().any(is_double),
        Expr::Tuple(e) => e.elems.iter().any(is_double),
        _ => false,
    }
}

/// Whether it is computed, which ids and enums are not.
fn is_computed(e: &Expr) -> bool {
    match bare(e) {
        Expr::Binary(e) => matches!(
            e.op,
            BinOp::Add(_) | BinOp::Sub(_) | BinOp::Mul(_) | BinOp::Div(_)
        ),
        _ => false,
    }
}

/// Whether an operator compares values that may be f64.
fn compares(op: &BinOp, sides: [&Expr; 2]) -> bool {
    let is_shown = sides.iter().any(|side| is_double(side));
    let is_open = !sides.iter().any(|side| is_whole(side));
    match op {
        BinOp::Lt(_) | BinOp::Le(_) | BinOp::Gt(_) | BinOp::Ge(_) => is_shown || is_open,
        BinOp::Eq(_) | BinOp::Ne(_) => {
            is_shown || is_open && sides.iter().any(|side| is_computed(side))
        }
        _ => false,
    }
}

/// Whether it is a range of values that may be f64.
fn is_open_range(e: &Expr) -> bool {
    let Expr::Range(range) = bare(e) else {
        return false;
    };
    let mut ends = range.start.iter().chain(&range.end);
    !ends.any(|end| is_whole(end))
}

/// The expressions in a macro's body, if it is a list of them or the body of `matches!`.
fn expressions(tokens: proc_macro2::TokenStream) -> Vec<Expr> {
    let list = Punctuated::<Expr, Token![,]>::parse_terminated;
    if let Ok(all) = list.parse2(tokens.clone()) {
        return all.into_iter().collect();
    }
    let repeated = Punctuated::<Expr, Token![;]>::parse_terminated;
    if let Ok(all) = repeated.parse2(tokens.clone()) {
        return all.into_iter().collect();
    }
    let matching = |input: ParseStream<'_>| {
        let mut found = vec![input.parse::<Expr>()?];
        input.parse::<Token![,]>()?;
        syn::Pat::parse_multi_with_leading_vert(input)?;
        if input.parse::<Option<Token![if]>>()?.is_some() {
            found.push(input.parse()?);
        }
        input.parse::<Option<Token![,]>>()?;
        Ok(found)
    };
    matching.parse2(tokens).unwrap_or_default()
}

/// The comparisons that may be of f64 values, with their lines.
#[derive(Default)]
struct Comparisons(Vec<(usize, String)>);

impl Comparisons {
    fn in_text(text: &str) -> Vec<(usize, String)> {
        let mut all = Self::default();
        all.visit_file(&syn::parse_file(text).unwrap());
        all.0
    }

    fn note(&mut self, at: &impl Spanned) {
        let span = at.span();
        let text = span.source_text().unwrap_or_default();
        let words: Vec<&str> = text.split_whitespace().collect();
        self.0.push((span.start().line, words.join(" ")));
    }
}

impl<'a> Visit<'a> for Comparisons {
    fn visit_expr_binary(&mut self, e: &'a syn::ExprBinary) {
        if compares(&e.op, [&e.left, &e.right]) {
            self.note(e);
        }
        visit::visit_expr_binary(self, e);
    }

    fn visit_expr_method_call(&mut self, e: &'a syn::ExprMethodCall) {
        let holds = e.method == "contains" && is_open_range(&e.receiver);
        if holds || is_one_of(COMPARING, &e.method) {
            self.note(e);
        }
        visit::visit_expr_method_call(self, e);
    }

    /// `f64::lt`, passed as a function.
    fn visit_expr_path(&mut self, e: &'a syn::ExprPath) {
        if let [_, .., name] = &names(&e.path)[..]
            && is_one_of(COMPARING, name)
        {
            self.note(e);
        }
    }

    /// `0.0..1.0`.
    fn visit_pat(&mut self, e: &'a syn::Pat) {
        if let syn::Pat::Range(range) = e
            && range
                .start
                .iter()
                .chain(&range.end)
                .any(|end| is_double(end))
        {
            self.note(e);
        }
        visit::visit_pat(self, e);
    }

    fn visit_macro(&mut self, e: &'a syn::Macro) {
        for e in expressions(e.tokens.clone()) {
            Comparisons::visit_expr(self, &e);
        }
    }

    fn visit_item_mod(&mut self, e: &'a syn::ItemMod) {
        let is_test = |a: &syn::Attribute| {
            a.path().is_ident("cfg") && a.parse_args::<syn::Ident>().is_ok_and(|i| i == "test")
        };
        if !e.attrs.iter().any(is_test) {
            visit::visit_item_mod(self, e);
        }
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The source files of code that decides.
fn deciding() -> Vec<PathBuf> {
    let excepted: Vec<PathBuf> = EXCEPTIONS.iter().map(|(p, _)| root().join(p)).collect();
    let mut found = Vec::new();
    let mut waiting: Vec<PathBuf> = SOURCES.iter().map(|p| root().join(p)).collect();
    while let Some(path) = waiting.pop() {
        if excepted.contains(&path) {
            continue;
        }
        if path.is_dir() {
            waiting.extend(fs::read_dir(path).unwrap().map(|e| e.unwrap().path()));
        } else if path.extension().is_some_and(|e| e == "rs") && !path.ends_with("tests.rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The comparisons in an expression.
fn found_in(expression: &str) -> usize {
    Comparisons::in_text(&format!("fn f() {{ {expression}; }}")).len()
}

#[test]
fn comparisons_of_doubles_are_seen() {
    for expression in [
        "x.norm() <= near",
        "a.dot(&b) > N::ZERO",
        "t < hi",
        "-x < -y",
        "size == 0.0",
        "hi - lo != cycle",
        "n <= 1.0",
        "k[2] < q",
        "turn as f64 > n",
        "side(p) != Some(0.0)",
        "*step == predicates.resolution::<N>()",
        "(lo..=hi).contains(&t)",
        "a.partial_cmp(&b)",
        "a.total_cmp(&b).is_lt()",
        "all.is_sorted_by(f64::le)",
        "all.iter().any(|t| *t > from)",
        "all.iter().sum::<f64>() > limit",
        "assert!(x > y, \"{x}\")",
        "matches!(met, Some(m) | Old(m) if m.t <= hi)",
        "vec![x < y; 3]",
        "match t { 0.0..1.0 => a, x if x < hi => b, _ => c }",
        "if let Some(t) = root && t < hi {}",
    ] {
        assert!(found_in(expression) > 0, "{expression}");
    }
}

#[test]
fn what_is_whole_or_exact_passes() {
    for expression in [
        "i + 1 < all.len()",
        "depth >= 16",
        "self.depth[&a] >= self.depth[&b]",
        "(n as usize) <= most",
        "all.iter().map(len).sum::<usize>() < most",
        "usize::from(a) < b",
        "p.degree() > least",
        "slope > Rational::ZERO",
        "a.vertex == b.vertex",
        "side == Side::On",
        "found + 1 == whole",
        "found + more == all.len()",
        "i + n - j <= back",
        "(0..4).contains(&turn)",
        "names.contains(&name)",
        "x.is_beyond(limit) && t.lies_in([lo, hi])",
        "a.total_cmp(&b)",
    ] {
        assert_eq!(found_in(expression), 0, "{expression}");
    }
    let test = "#[cfg(test)] mod tests { fn f() { x < y; } }";
    assert_eq!(Comparisons::in_text(test), []);
}

#[test]
fn numbers_are_asked_about_in_one_place() {
    for (path, _) in EXCEPTIONS {
        assert!(root().join(path).exists(), "{path}");
    }
    let files = deciding();
    assert!(files.len() > 40);
    let mut wrong = Vec::new();
    for path in files {
        let text = fs::read_to_string(&path).unwrap();
        for (line, text) in Comparisons::in_text(&text) {
            wrong.push(format!("{}:{line}: {text}", path.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
