//! Loops, functions, parts with parameters, included files and overrides of `.padl`.

use super::*;
use insta::assert_snapshot;
use premio_kernel::number::rational::from_f64;
use proptest::prelude::*;
use std::collections::HashMap;

fn padl(text: &str) -> Tree {
    tree(text, Format::Padl)
}

fn refused(text: &str) -> String {
    message(text, Format::Padl)
}

/// The value of an expression of numbers.
fn value(expression: &str) -> Rational {
    // A negative number is no radius.
    let tree = padl(&format!("P = SPH(R=1) AT (MOVX=({expression}), MOVY=1)"));
    let leaf = tree.leaves().next().unwrap().1;
    leaf.motion.offset()[0].clone()
}

fn ratio(n: i64, d: u64) -> Rational {
    Rational::from_parts(n.into(), d.into())
}

/// Files in memory.
#[derive(Debug, Default)]
struct Library(HashMap<String, Vec<u8>>);

impl IncludeLoader for Library {
    fn find(&self, including: Option<&str>, path: &str) -> Result<IncludePath, IncludeError> {
        let folder = including.and_then(|name| name.rsplit_once('/'));
        let name = folder.map_or(path.to_owned(), |(folder, _)| format!("{folder}/{path}"));
        let identity = name.clone();
        match including.is_none() || self.0.contains_key(&name) {
            true => Ok(IncludePath { name, identity }),
            false => Err(IncludeError::new("no such file")),
        }
    }

    fn load(&self, file: &IncludePath) -> Result<Vec<u8>, IncludeError> {
        Ok(self.0[&file.name].clone())
    }
}

fn with_files(text: &str, files: &[(&str, &str)]) -> Result<Program, ReadError> {
    let files = files.iter();
    let files = files.map(|(name, text)| ((*name).to_owned(), text.as_bytes().to_vec()));
    let options = ReadOptions {
        includes: Includes::new(Library(files.collect())),
        ..ReadOptions::default()
    };
    parse("part", text.as_bytes(), Format::Padl, &options)
}

fn with_values(text: &str, values: &[(&str, &str)]) -> Result<Program, ReadError> {
    let values = values.iter().map(|(name, value)| ValueOverride {
        name: (*name).to_owned(),
        value: (*value).to_owned(),
    });
    let options = ReadOptions {
        overrides: values.collect(),
        ..ReadOptions::default()
    };
    parse("part", text.as_bytes(), Format::Padl, &options)
}

fn tree_of(program: &Program) -> Tree {
    program.builder.finish(program.part).unwrap()
}

#[test]
fn functions_are_exact_where_they_are_rational() {
    assert_eq!(value("sin(30)"), ratio(1, 2));
    assert_eq!(value("sin(-30)"), ratio(-1, 2));
    assert_eq!(value("Sin(150 + 360*1000)"), ratio(1, 2));
    assert_eq!(value("sin(210)"), ratio(-1, 2));
    assert_eq!(value("sin(270)"), ratio(-1, 1));
    assert_eq!(value("sin(180)"), ratio(0, 1));
    assert_eq!(value("COS(60)"), ratio(1, 2));
    assert_eq!(value("cos(120)"), ratio(-1, 2));
    assert_eq!(value("cos(90)"), ratio(0, 1));
    assert_eq!(value("cos(0)"), ratio(1, 1));
    assert_eq!(value("tan(45)"), ratio(1, 1));
    assert_eq!(value("tan(135)"), ratio(-1, 1));
    assert_eq!(value("tan(-45)"), ratio(-1, 1));
    assert_eq!(value("tan(225)"), ratio(1, 1));
    assert_eq!(value("tan(180)"), ratio(0, 1));
    assert_eq!(value("sqrt(9/16)"), ratio(3, 4));
    assert_eq!(value("sqrt(0)"), ratio(0, 1));
    assert_eq!(value("min(3, 1/2, 2)"), ratio(1, 2));
    assert_eq!(value("max(3, 1/2, 7/2)"), ratio(7, 2));
    assert_eq!(value("min(-5)"), ratio(-5, 1));
}

#[test]
fn other_values_are_the_nearest_f64() {
    let nearest = |x: f64| from_f64(x).unwrap();
    assert_eq!(value("pi"), nearest(std::f64::consts::PI));
    assert_eq!(value("PI/2*2"), nearest(std::f64::consts::PI));
    assert_eq!(value("sqrt(2)"), nearest(std::f64::consts::SQRT_2));
    // From tables.
    assert_eq!(value("sin(45)"), nearest(std::f64::consts::FRAC_1_SQRT_2));
    assert_eq!(value("cos(30)"), nearest(0.866_025_403_784_438_6));
    assert_eq!(value("tan(60)"), nearest(1.732_050_807_568_877_3));
    assert_eq!(value("sin(1)"), nearest(0.017_452_406_437_283_51));
    assert_eq!(value("tan(89)"), nearest(57.289_961_630_759_42));
    assert_eq!(value("sin(1e-300)"), nearest(1.745_329_251_994_329_6e-302));
}

#[test]
fn a_rounded_value_is_remarked_on_once() {
    let notes = |text: &str| {
        let read = read_text(text, Format::Padl).unwrap();
        assert_eq!(read.digits, None);
        let notes = read.notes.into_iter();
        notes.map(|note| note.text).collect::<Vec<_>>()
    };
    assert_eq!(notes("P = SPH(R=sqrt(4)*sin(30)*max(1, 2))"), [""; 0]);
    assert_snapshot!(notes("P = SPH(R=sqrt(2))").concat(), @"this value of `sqrt` is irrational: it is read as the nearest f64, 1.4142135623730951");
    assert_snapshot!(notes("P = SPH(R=sqrt(2)) UN SPH(R=pi)").concat(), @"this value of `sqrt` is irrational: it is read as the nearest f64, 1.4142135623730951 (and once more)");
    assert_snapshot!(notes("P = FOR i=1..100: SPH(R=sin(i))").concat(), @"this value of `sin` is irrational: it is read as the nearest f64, 0.01745240643728351 (and 97 times more)");
    assert_snapshot!(notes("P = SPH(R=1) DIF FOR i=7..0: SPH(R=2)").concat(), @"the range 7..0 contains no number: `FOR` adds nothing");
}

#[test]
fn a_loop_takes_the_operation_in_which_it_stands() {
    let same = |loops: &str, text: &str| {
        let prefix = "A = BLO(X=9, Y=9, Z=9)\nB = SPH(R=2)\n";
        let read = |text: &str| padl(&format!("{prefix}P = {text}"));
        assert_eq!(read(loops), read(text), "{loops}");
    };
    let moved = |i: i32| format!("B AT (MOVX={i})");
    let [b0, b1, b2, b4] = [0, 1, 2, 4].map(moved);
    same(
        "A DIF FOR i=1..2: B AT (MOVX=i)",
        &format!("A DIF {b1} DIF {b2}"),
    );
    same(
        "A INT FOR i=1..2: B AT (MOVX=i)",
        &format!("A INT {b1} INT {b2}"),
    );
    same(
        "A UN FOR i=1..2: B AT (MOVX=i)",
        &format!("A UN {b1} UN {b2}"),
    );
    same("FOR i=1..2: B AT (MOVX=i)", &format!("{b1} UN {b2}"));
    same(
        "FOR i=1..2: B AT (MOVX=i) INT A",
        &format!("({b1} UN {b2}) INT A"),
    );
    same(
        "A DIF (FOR i=1..2: B AT (MOVX=i))",
        &format!("A DIF ({b1} UN {b2})"),
    );
    same(
        "A DIF for i=1..2: B AT (MOVX=i) UN B",
        &format!("A DIF {b1} DIF {b2} UN B"),
    );
    same(
        "A DIF FOR i=0..4 STEP 2: B AT (MOVX=i)",
        &format!("A DIF {b0} DIF {b2} DIF {b4}"),
    );
    same(
        "A DIF FOR i=2..0 step -2: B AT (MOVX=i)",
        &format!("A DIF {b2} DIF {b0}"),
    );
    same(
        "A DIF FOR i=2..2: (B UN A) AT (MOVX=i)",
        "A DIF (B UN A) AT (MOVX=2)",
    );
    same("A DIF FOR i=-1..-1: B AT (MOVX=-i)", &format!("A DIF {b1}"));
    same(
        "A DIF FOR i=1..1+1:\n  B AT (MOVX=i)",
        &format!("A DIF {b1} DIF {b2}"),
    );
    same("A DIF FOR i=1..0: B", "A");
    same("A INT FOR i=1..0: B", "A");
    same("(FOR i=1..0: B) UN A", "A");
}

#[test]
fn loops_are_nested() {
    let ball = |x: i32, y: i32| format!("SPH(R=1) AT (MOVX={x}, MOVY={y})");
    let all = [[0, 5], [0, 6], [1, 5], [1, 6]].map(|[x, y]| ball(x, y));
    let expected = padl(&format!("P = BLO(X=9, Y=9, Z=9) DIF {}", all.join(" DIF ")));
    for loops in [
        "FOR x=0..1: FOR y=5..6: SPH(R=1) AT (MOVX=x, MOVY=y)",
        "FOR x=0..1: (FOR y=5..6: SPH(R=1) AT (MOVX=x, MOVY=y))",
    ] {
        let tree = padl(&format!("P = BLO(X=9, Y=9, Z=9) DIF {loops}"));
        assert_same_points(&tree, |point| inside(&expected, point));
    }
    let flat =
        padl("P = BLO(X=9, Y=9, Z=9) DIF FOR x=0..1: FOR y=5..6: SPH(R=1) AT (MOVX=x, MOVY=y)");
    assert_eq!(flat, expected);
    // The range of the inner loop depends on the outer one: 1 + 2 + 3 balls.
    let triangle = padl("P = FOR i=1..3: FOR j=1..i: SPH(R=1) AT (MOVX=3*i, MOVY=3*j)");
    assert_eq!(triangle.leaves().count(), 6);
    // A loop in a range, and one in an argument of a part.
    let rows = "ROW(S, N) = FOR i=1..N: S AT (MOVX=9*i)\nP = ROW(S=FOR k=1..2: SPH(R=k), N=3)";
    assert_eq!(padl(rows).leaves().count(), 6);
}

#[test]
fn parts_have_parameters() {
    let head = "E = 1\nHOLE(D, L=2*D+E) = CYL(R=D/2, H=L)\n";
    let hole = |use_of: &str| padl(&format!("{head}P = {use_of}"));
    let cylinder = |r: &str, h: &str| padl(&format!("P = CYL(R={r}, H={h})"));
    assert_eq!(hole("HOLE(8)"), cylinder("4", "17"));
    assert_eq!(hole("HOLE(D=8)"), cylinder("4", "17"));
    assert_eq!(hole("HOLE(8, 3)"), cylinder("4", "3"));
    assert_eq!(hole("HOLE(8, L=3)"), cylinder("4", "3"));
    assert_eq!(hole("HOLE(L=3, D=8)"), cylinder("4", "3"));
    assert_eq!(hole("HOLE(\n  L = 3,\n  D = 8\n)"), cylinder("4", "3"));
    // Numbers with parameters, and parts without.
    assert_eq!(
        padl("HALF(X) = X/2\nP = SPH(R=HALF(HALF(4)))"),
        padl("P = SPH(R=1)")
    );
    assert_eq!(padl("BALL() = SPH(R=1)\nP = BALL()"), padl("P = SPH(R=1)"));
    // A solid as an argument, and a part in a part.
    let pair =
        "PAIR(S, X) = S UN S AT (MOVX=X)\nFOUR(S) = PAIR(PAIR(S, 2), X=9)\nP = FOUR(SPH(R=1))";
    assert_eq!(padl(pair).leaves().count(), 4);
    // A definition is no solid: the part is the last solid.
    assert_eq!(
        padl("A = SPH(R=1)\nB(R) = CYL(R=R, H=1)"),
        padl("A = SPH(R=1)")
    );
}

#[test]
fn inner_names_hide_outer_ones() {
    let text = "D = 5\ni = 7\nBALL(D) = SPH(R=D) AT (MOVX=i)\nP = BALL(2) UN FOR i=1..1: SPH(R=i) UN SPH(R=i) UN SPH(R=D)";
    let expected = "P = SPH(R=2) AT (MOVX=7) UN SPH(R=1) UN SPH(R=7) UN SPH(R=5)";
    assert_eq!(padl(text), padl(expected));
}

#[test]
fn files_may_use_the_new_words_as_names() {
    let text = "FOR = 2\nsin = 3\npi = 4\nStep = 5\ninclude = 6\nmax = SPH(R=pi)\nP = max UN SPH(R=FOR) UN SPH(R=sin*Step+include)";
    assert_eq!(padl(text), padl("P = SPH(R=4) UN SPH(R=2) UN SPH(R=21)"));
    // Another spelling keeps its meaning.
    assert_eq!(
        padl("sin = 3\nP = SPH(R=SIN(90)+sin)"),
        padl("P = SPH(R=4)")
    );
    assert_eq!(
        padl("N = 2\nP = FOR i=1..N: SPH(R=i)"),
        padl("P = SPH(R=1) UN SPH(R=2)")
    );
}

#[test]
fn included_files_are_statements() {
    let files = [
        ("lib/a.padl", "\u{feff}INCLUDE \"b.padl\"\nA = 2 * B"),
        ("lib/b.padl", "B = 3 # three"),
    ];
    let text = "X = 1\nINCLUDE \"lib/a.padl\" # c\ninclude \"lib/b.padl\"\nP = SPH(R=A+B+X)\n";
    let program = with_files(text, &files).unwrap();
    assert_eq!(tree_of(&program), padl("P = SPH(R=10)"));
    let names: Vec<&str> = program.included.iter().map(|file| &*file.name).collect();
    assert_eq!(names, ["lib/a.padl", "lib/b.padl"]);
    let standalone = program.standalone.rewritten().unwrap();
    assert_eq!(padl(standalone), padl("P = SPH(R=10)"));
    assert_snapshot!(standalone, @r#"
X = 1
B = 3 # three

A = 2 * B
 # c

P = SPH(R=A+B+X)
"#);
    // The last solid may be in an included file.
    let files = [("a.padl", "P = SPH(R=2)")];
    let program = with_files("A = SPH(R=1)\nINCLUDE \"a.padl\"", &files).unwrap();
    assert_eq!(tree_of(&program), padl("P = SPH(R=2)"));
    assert_eq!(
        padl("P = SPH(R=1)"),
        tree_of(&with_files("P = SPH(R=1)", &[]).unwrap())
    );
    let alone = with_files("P = SPH(R=1)", &[]).unwrap().standalone;
    assert_eq!(alone, StandaloneText::AsRead);
}

#[test]
fn values_are_overridden() {
    let text = "L = 60 # length\nW = L/2\nP = BLO(X=L, Y=W, Z=1)";
    let with = |values: &[(&str, &str)]| with_values(text, values).unwrap();
    let expected = |x: &str, y: &str| padl(&format!("P = BLO(X={x}, Y={y}, Z=1)"));
    assert_eq!(tree_of(&with(&[])), expected("60", "30"));
    assert_eq!(tree_of(&with(&[("L", "80")])), expected("80", "40"));
    assert_eq!(
        tree_of(&with(&[("W", "L/3"), ("L", "2*(3+sqrt(4))")])),
        expected("10", "10/3")
    );
    let program = with(&[("W", "7 # wide"), ("L", "1/3")]);
    let standalone = program.standalone.rewritten().unwrap();
    assert_eq!(padl(standalone), tree_of(&program));
    assert_snapshot!(standalone, @r#"
L = (1/3) # length
W = (7 # wide
)
P = BLO(X=L, Y=W, Z=1)
"#);
}

fn error_of(program: Result<Program, ReadError>) -> String {
    let error = program.unwrap_err();
    assert!(error.text.is_some() || &*error.name == "part", "{error}");
    error.to_string()
}

#[test]
fn messages_of_loops() {
    let after = |text: &str| refused(&format!("B = SPH(R=1)\nP = B DIF {text}"));
    assert_snapshot!(after("FOR 3"), @"part:2:15: found `3`, expected a variable, as in `FOR i=0..7: HOLE`");
    assert_snapshot!(after("FOR i 0..7: B"), @"part:2:17: found `0`, expected `=` after the variable of `FOR`");
    assert_snapshot!(after("FOR i=0: B"), @"part:2:18: found `:`, expected an operator or `..`");
    assert_snapshot!(after("FOR i=0,7: B"), @"part:2:18: found `,`, expected an operator or `..`");
    assert_snapshot!(after("FOR i=0..7 B"), @"part:2:22: found `B`, expected an operator or the end of the value");
    assert_snapshot!(after("FOR i=0..7 STPE 2: B"), @"part:2:22: found `STPE`, expected an operator or the end of the value (did you mean `STEP`?)");
    assert_snapshot!(after("FOR i=0..7 STEP 2 B"), @"part:2:29: found `B`, expected an operator or the end of the value");
    assert_snapshot!(after("FOR i=0..7 STEP 0: B"), @"part:2:27: found the number 0, expected a step other than zero");
    assert_snapshot!(after("FOR i=1/2..7: B"), @"part:2:17: found the number 0.5, expected a whole number for the start of the range");
    assert_snapshot!(after("FOR i=0..B: B"), @"part:2:20: found a solid, expected a number for the end of the range");
    assert_snapshot!(after("FOR i=0..1e3 STEP 0.5: B"), @"part:2:29: found the number 0.5, expected a whole number for the step");
    assert_snapshot!(after("FOR i=0..7:"), @"part:2:22: found the end of the file, expected a number, a name, a primitive or `(`");
    assert_snapshot!(after("FOR i=0..7: i"), @"part:2:23: found the number 0, expected a solid after `FOR` (`i` is 0)");
    assert_snapshot!(after("FOR UN=0..7: B"), @"part:2:15: found the keyword `UN`, expected a name that is not a keyword");
    assert_snapshot!(after("FOR i=0..7: FOR i=0..7: B"), @"part:2:27: found `i`, which is a parameter or a variable here already, expected another name (it was introduced on line 2)");
    assert_snapshot!(after("FOR i=-1..1: SPH(R=1/i)"), @"part:2:30: found the value -1, expected a radius greater than zero (`i` is -1)");
    assert_snapshot!(after("FOR i=0..1e9: B"), @"part:2:17: found a range of 1000000001 numbers, expected at most 250000 primitives, motions and set operations in all `FOR` and parts with parameters");
    assert_snapshot!(after("FOR i=0..1e99: B"), @"part:2:17: found a range of more than 1e19 numbers, expected at most 250000 primitives, motions and set operations in all `FOR` and parts with parameters");
    assert_snapshot!(after("FOR i=1..600: FOR j=1..600: B"), @"part:2:11: found an expansion beyond the limit, expected at most 250000 primitives, motions and set operations in all `FOR` and parts with parameters (`j` is 401, `i` is 417)");
    assert_snapshot!(after("B UN i"), @"part:2:16: found the unknown name `i`, expected a name set on an earlier line");
    assert_snapshot!(refused("P = 2 DIF FOR i=0..7: SPH(R=1)"), @"part:1:5: found the number 2, expected a solid before `DIF`");
    assert_snapshot!(refused("P = 2 + FOR i=0..7: SPH(R=1)"), @"part:1:9: found `FOR`, expected a number; `FOR` stands first or after `UN`, `INT` or `DIF`");
    assert_snapshot!(refused("P = FOR i=0..7: SPH(R=1) + 1"), @"part:1:5: found a solid, expected a number before `+`");
    assert_snapshot!(refused("P = (FOR i=0..7"), @"part:1:16: found the end of the file, expected an operator, `STEP` or `:` (the bracket opened on line 1 is not closed)");
    assert_snapshot!(refused("A = 1..2"), @"part:1:6: found `..`, expected an operator or the end of the line");
}

#[test]
fn messages_of_functions() {
    assert_snapshot!(refused("A = sqrt(2 - 3)"), @"part:1:10: found the value -1 in `sqrt`, expected a number of zero or more");
    assert_snapshot!(refused("A = tan(450)"), @"part:1:9: found the value 450 in `tan`, expected an angle other than 90 degrees and its odd multiples");
    assert_snapshot!(refused("A = sin()"), @"part:1:9: found `)`, expected a number for `sin`");
    assert_snapshot!(refused("A = sin(1, 2)"), @"part:1:10: found `,`, expected one argument of `sin`");
    assert_snapshot!(refused("A = max()"), @"part:1:9: found `)`, expected a number for `max`");
    assert_snapshot!(refused("A = max(1,)"), @"part:1:11: found `)`, expected a number, a name, a primitive or `(`");
    assert_snapshot!(refused("A = sin 30"), @"part:1:9: found `30`, expected `(` and the arguments of `sin`");
    assert_snapshot!(refused("A = sin(30"), @"part:1:11: found the end of the file, expected an operator or a closing `)` (the bracket opened on line 1 is not closed)");
    assert_snapshot!(refused("A = sin(SPH(R=1))"), @"part:1:9: found a solid, expected a number for `sin`");
    assert_snapshot!(refused("A = sqt(4)"), @"part:1:5: found the unknown name `sqt`, expected a name set on an earlier line (did you mean `sqrt`?)");
    assert_snapshot!(refused("A = sqrt(2e400*1e400)"), @"part:1:5: found a value of `sqrt` beyond the range of f64, expected a value of at most 1.8e308");
    assert_snapshot!(refused("P = SPH(R=pi(3))"), @"part:1:13: found `(`, expected an operator or a closing `)`");
}

#[test]
fn messages_of_parts() {
    let after = |text: &str| refused(&format!("HOLE(D, L=4) = CYL(R=D/2, H=L)\nP = {text}"));
    assert_snapshot!(after("HOLE()"), @"part:2:10: found `)`, expected the argument `D` of `HOLE`");
    assert_snapshot!(after("HOLE(L=3)"), @"part:2:13: found `)`, expected the argument `D` of `HOLE`");
    assert_snapshot!(after("HOLE(2, D=3)"), @"part:2:13: found `D` a second time, expected each argument once");
    assert_snapshot!(after("HOLE(D=2, d=3)"), @"part:2:15: found the unknown argument `d`, expected an argument of `HOLE`, one of `D`, `L`");
    assert_snapshot!(after("HOLE(D=2, 3)"), @"part:2:15: found an argument without a name after one with a name, expected an argument of `HOLE`, one of `D`, `L`");
    assert_snapshot!(after("HOLE(1, 2, 3)"), @"part:2:16: found one argument too many, expected an argument of `HOLE`, one of `D`, `L`");
    assert_snapshot!(after("HOLE"), @"part:2:9: found the end of the file, expected `(` and the arguments of `HOLE`");
    assert_snapshot!(after("HOLE(-2)"), @"part:1:22: found the value -1, expected a radius greater than zero (in `HOLE` used on line 2)");
    assert_snapshot!(after("HOLE(SPH(R=1))"), @"part:1:22: found a solid, expected a number before `/` (in `HOLE` used on line 2)");
    assert_snapshot!(after("HOEL(2)"), @"part:2:5: found the unknown name `HOEL`, expected a name set on an earlier line (did you mean `HOLE`?)");
    assert_snapshot!(after("SPH(R=1)\nHOLE = 3"), @"part:3:1: found `HOLE`, which is set already, expected a new name (it was set on line 1)");
    assert_snapshot!(refused("A(X) = A(X-1)"), @"part:1:8: found the unknown name `A`, expected a name set on an earlier line (a part does not use itself)");
    assert_snapshot!(refused("A(X) = B(X)\nB(X) = A(X)"), @"part:1:8: found the unknown name `B`, expected a name set on an earlier line");
    assert_snapshot!(refused("A(X) = SPH(R=Y)\nP = SPH(R=1)"), @"part:1:14: found the unknown name `Y`, expected a name set on an earlier line");
    assert_snapshot!(refused("A(X, X) = SPH(R=X)"), @"part:1:6: found `X`, which is a parameter or a variable here already, expected another name (it was introduced on line 1)");
    assert_snapshot!(refused("A(X=X) = SPH(R=X)"), @"part:1:5: found the unknown name `X`, expected a name set on an earlier line");
    assert_snapshot!(refused("A(AT) = SPH(R=1)"), @"part:1:3: found the keyword `AT`, expected a name that is not a keyword");
    assert_snapshot!(refused("A(3) = SPH(R=1)"), @"part:1:3: found `3`, expected the name of a parameter");
    assert_snapshot!(refused("A(X Y) = SPH(R=1)"), @"part:1:5: found `Y`, expected `=` and a default, `,` or `)`");
    assert_snapshot!(refused("A(X) SPH(R=1)"), @"part:1:6: found `SPH`, expected `=` after the parameters");
    assert_snapshot!(refused("A(X = SPH(R=1)"), @"part:1:15: found the end of the file, expected an operator or a closing `)`");
    assert_snapshot!(refused("A() = SPH(R=1)\nP = A(2)"), @"part:2:7: found one argument too many, expected no arguments of `A`");
    assert_snapshot!(refused("A(X) = SPH(R=X)"), @"part:1:16: found no solid in the file, expected a line such as `PART = BLO(X=1, Y=1, Z=1)`");
    assert_snapshot!(refused("A(X) = SPH(R=X)\nB(X) = A(X-1)\nP = FOR i=1..3: B(i)"), @"part:1:14: found the value 0, expected a radius greater than zero (in `A` used on line 2, in `B` used on line 3, `i` is 1)");
    let options = ReadOptions {
        part: Some("A".to_owned()),
        ..ReadOptions::default()
    };
    let text = b"A(X) = SPH(R=X)\nB = A(2)";
    let error = read("part", text, Format::Padl, &options).unwrap_err();
    assert_snapshot!(error, @"part:1:1: found `A`, which is a part with parameters, expected the name of a solid");
}

#[test]
fn messages_of_included_files() {
    let refused = |text: &str, files: &[(&str, &str)]| error_of(with_files(text, files));
    let one = |text: &str| refused("INCLUDE \"a.padl\"\nP = SPH(R=1)", &[("a.padl", text)]);
    assert_snapshot!(one("A = 1\nB = A +"), @"a.padl:2:8: found the end of the file, expected a number, a name, a primitive or `(` (included on line 1 of part)");
    assert_snapshot!(one("A = 1 ? 2"), @"a.padl:1:7: found `?`, expected a name, a number or a symbol of the language (included on line 1 of part)");
    assert_snapshot!(one("P = 3"), @"part:2:1: found `P`, which is set already, expected a new name (it was set on line 1 of a.padl)");
    assert_snapshot!(one("INCLUDE \"a.padl\""), @"a.padl:1:9: found `a.padl`, which is being read, expected a file that does not include this one (a.padl includes itself: a.padl, a.padl; included on line 1 of part)");
    assert_snapshot!(one("INCLUDE \"part\""), @"a.padl:1:9: found `part`, expected a file that ends in `.padl` (included on line 1 of part)");
    assert_snapshot!(one("INCLUDE \"b.padl\""), @"a.padl:1:9: found `b.padl`, which is not read: no such file, expected a file that can be read (included on line 1 of part)");
    assert_snapshot!(refused("A = 1\nINCLUDE \"a.padl\"", &[("a.padl", "A = 2")]), @"a.padl:1:1: found `A`, which is set already, expected a new name (it was set on line 1 of part; included on line 2 of part)");
    assert_snapshot!(refused("INCLUDE \"a.padl\"\nP = B(-1)", &[("a.padl", "B(R) = SPH(R=R)")]), @"a.padl:1:14: found the value -1, expected a radius greater than zero (in `B` used on line 2 of part)");
    assert_snapshot!(refused("INCLUDE \"a.padl\"\nINCLUDE \"b.padl\"", &[("a.padl", "B(R) = SPH(R=R)"), ("b.padl", "P = B(0)")]), @"a.padl:1:14: found the value 0, expected a radius greater than zero (in `B` used on line 1 of b.padl; included on line 2 of part)");
    let path = |path: &str| refused(&format!("INCLUDE {path}"), &[]);
    assert_snapshot!(path("\"/a.padl\""), @"part:1:9: found `/a.padl`, expected a path relative to the folder of this file");
    assert_snapshot!(path("\"C:/a.padl\""), @"part:1:9: found `C:/a.padl`, expected a path relative to the folder of this file");
    assert_snapshot!(path("\"b\\\\a.padl\""), @r#"part:1:9: found `b\\a.padl`, expected a path with `/` between its folders"#);
    assert_snapshot!(path("\"a.txt\""), @"part:1:9: found `a.txt`, expected a file that ends in `.padl`");
    assert_snapshot!(path("\"\""), @"part:1:9: found ``, expected a file that ends in `.padl`");
    assert_snapshot!(path("a.padl"), @"part:1:10: found `.`, expected a name, a number or a symbol of the language");
    assert_snapshot!(path("\"a.padl\" 3"), @"part:1:18: found `3`, expected the end of the line");
    assert_snapshot!(message("INCLUDE \"a.padl\"", Format::Padl), @"part:1:1: found `INCLUDE`, and no way to read other files, expected a text in one file");
    assert_snapshot!(message("INCLDE \"a.padl\"", Format::Padl), @r#"part:1:8: found `"a.padl"`, expected `=` after the name that is set (did you mean `INCLUDE`?)"#);
    let files: Vec<(String, String)> = (0..40)
        .map(|k| (format!("{k}.padl"), format!("INCLUDE \"{}.padl\"", k + 1)))
        .collect();
    let files: Vec<(&str, &str)> = files.iter().map(|(a, b)| (&**a, &**b)).collect();
    assert_snapshot!(refused("INCLUDE \"0.padl\"", &files), @"31.padl:1:9: found `32.padl`, inside 33 other files, expected at most 32 (included on line 1 of 30.padl)");
    let two = "INCLUDE \"b.padl\"";
    assert_snapshot!(refused("INCLUDE \"a.padl\"", &[("a.padl", two), ("b.padl", "A = B")]), @"b.padl:1:5: found the unknown name `B`, expected a name set on an earlier line (included on line 1 of a.padl)");
}

#[test]
fn messages_of_overrides() {
    let text = "LENGTH = 60\nA = SPH(R=1)\nB(X) = A\nP = A AT (MOVX=LENGTH)";
    let refused = |values: &[(&str, &str)]| error_of(with_values(text, values));
    assert_snapshot!(refused(&[("LENGHT", "3")]), @"-D LENGHT:1:1: found no number called `LENGHT`, expected a number that the file sets: `LENGTH` (did you mean `LENGTH`?)");
    assert_snapshot!(refused(&[("Q", "3")]), @"-D Q:1:1: found no number called `Q`, expected a number that the file sets: `LENGTH`");
    assert_snapshot!(refused(&[("A", "3")]), @"part:2:1: found `A`, which is a solid, expected a number, because another value is given for it");
    assert_snapshot!(refused(&[("B", "3")]), @"part:3:1: found `B`, which is a part with parameters, expected a number, because another value is given for it");
    assert_snapshot!(refused(&[("LENGTH", "3 +")]), @"-D LENGTH:1:11: found the end of the value, expected a number, a name, a primitive or `(`");
    assert_snapshot!(refused(&[("LENGTH", "")]), @"-D LENGTH:1:8: found the end of the value, expected a number, a name, a primitive or `(`");
    assert_snapshot!(refused(&[("LENGTH", "3)")]), @"-D LENGTH:1:9: found `)`, expected an operator or the end of the value");
    assert_snapshot!(refused(&[("LENGTH", "3\nX = 2")]), @"-D LENGTH:1:9: found the end of the line, expected an operator or the end of the value");
    assert_snapshot!(refused(&[("LENGTH", "SPH(R=1)")]), @"-D LENGTH:1:8: found a solid, expected a number for `LENGTH`");
    assert_snapshot!(refused(&[("LENGTH", "1/0")]), @"-D LENGTH:1:10: found a division by zero, expected a number other than zero");
    assert_snapshot!(refused(&[("LENGTH", "P")]), @"-D LENGTH:1:8: found the unknown name `P`, expected a name set on an earlier line");
    assert_snapshot!(refused(&[("LENGTH", "1"), ("LENGTH", "2")]), @"-D LENGTH:1:1: found `LENGTH` a second time, expected one value for each name");
    assert_snapshot!(error_of(with_values("P = SPH(R=1)", &[("L", "2")])), @"-D L:1:1: found no number called `L`, expected a number that the file sets; it sets none");
    let options = ReadOptions {
        overrides: vec![ValueOverride::default()],
        ..ReadOptions::default()
    };
    for format in [Format::Csg, Format::Json, Format::Asc, Format::Pov] {
        let error = read("part", b"", format, &options).unwrap_err();
        assert!(error.expected.contains("`.padl`"), "{error}");
    }
}

proptest! {
    #[test]
    fn a_loop_is_what_is_written_by_hand(
        first in -5i32..5,
        count in 1i32..6,
        step in prop::sample::select(vec![-3, -1, 1, 2]),
        operation in prop::sample::select(vec!["UN", "INT", "DIF"]),
    ) {
        let last = first + (count - 1) * step;
        let body = |i: &str| format!("(SPH(R=3) UN CYL(R=1, H=9) AT (ROTX={i}*30, MOVX={i}/3))");
        let head = "P = BLO(X=2, Y=2, Z=2)";
        let loops = format!("{head} {operation} FOR i={first}..{last} STEP {step}: {}", body("i"));
        let all = (0..count).map(|k| format!(" {operation} {}", body(&format!("({})", first + k * step))));
        let by_hand = format!("{head}{}", all.collect::<String>());
        prop_assert_eq!(padl(&loops), padl(&by_hand));
    }

    #[test]
    fn a_part_is_its_value_with_the_arguments(a in 1u32..100, b in 1u32..100) {
        let text = format!("BAR(A, B=A/7) = BLO(X=A, Y=B, Z=A+B) AT (MOVX=B)\nP = BAR({a}) UN BAR(B={b}, A={a})");
        let bar = |b: &str| format!("BLO(X={a}, Y={b}, Z={a}+{b}) AT (MOVX={b})");
        let by_hand = format!("P = {} UN {}", bar(&format!("({a}/7)")), bar(&b.to_string()));
        prop_assert_eq!(padl(&text), padl(&by_hand));
    }

    #[test]
    fn functions_agree_with_f64(degrees in -2000.0..2000.0f64, x in 0.0..1e6f64) {
        let radians = degrees.to_radians();
        let near = |text: String, expected: f64, within: f64| {
            let found = to_f64(&value(&text));
            prop_assert!((found - expected).abs() <= within, "{text} is {found}, not {expected}");
            Ok(())
        };
        let within = 1e-13 * (1.0 + radians.abs());
        near(format!("sin({degrees})"), radians.sin(), within)?;
        near(format!("cos({degrees})"), radians.cos(), within)?;
        let tangent = radians.tan();
        near(format!("tan({degrees})"), tangent, within * (1.0 + tangent * tangent))?;
        near(format!("sqrt({x})"), x.sqrt(), 3e-16 * x.sqrt())?;
    }

    #[test]
    fn the_square_of_a_root_is_exact(n in 0u64..1_000_000, d in 1u64..1_000_000) {
        let root = ratio(n.try_into().unwrap(), d);
        prop_assert_eq!(value(&format!("sqrt({n}*{n}/({d}*{d}))")), root);
    }
}
