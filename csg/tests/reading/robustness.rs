//! No text makes a reader panic, overflow the stack or take for ever.

use super::*;
use proptest::prelude::*;

const SEEDS: [(&str, Format); 8] = [
    (
        "P = HALF(1, -1/3, 0, D=2) INT OUT(ICYL(R=1) UN ICON(SLOPE=.5) AT (ROTX=90, MOVZ=-7)) INT BLO(X=3, Y=4, Z=5)\n",
        Format::Padl,
    ),
    (
        r#"{"op":"difference","children":[{"prim":"sphere","r":2},{"op":"complement","children":[{"prim":"half_space","normal":[1,2,-2],"offset":1},{"prim":"infinite_cylinder","r":1,"transform":[{"translate":[1,2,3]}]},{"prim":"infinite_cone","slope":0.5}]}]}"#,
        Format::Json,
    ),
    (
        "N = 3\nHOLE(D, L=2*D) = CYL(R=D/2, H=L) AT (MOVZ=-min(L, 9)/2)\nROW(S, N=2) = S UN FOR i=1..N STEP 1: S AT (MOVX=4*i)\nP = BLO(X=9, Y=9, Z=1) DIF FOR i=0..N: FOR j=0..1: HOLE(D=sqrt(2)) AT (MOVX=i*cos(60), MOVY=j+sin(30)) DIF ROW(S=HOLE(1, L=3), N=max(1, 3)) AT (MOVX=pi)\n",
        Format::Padl,
    ),
    (
        "L = 6\nA = BLO(X=L, Y=4*2, Z=2e0) # c\nP = (A DIF CYL(R=1, H=3) AT (MOVX=L/2, ROTZ=-30)) UN A\n",
        Format::Padl,
    ),
    (
        "difference() { cube(size = [1, 2, 3], center = true); multmatrix([[0.866025, -0.5, 0, 1], [0.5, 0.866025, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { cylinder($fn = 0, h = 4, r1 = 2, r2 = 1); } rotate_extrude() { multmatrix([[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { circle(r = 1); } } linear_extrude(height = 2) { polygon(points = [[0,0],[1,0],[0,1]], paths = undef); } }",
        Format::Csg,
    ),
    (
        r#"{"op":"union","children":[{"prim":"block","size":[1,2,3],"transform":[{"translate":[1,2,3]},{"rotate":[[0,0,1],30]}]},{"prim":"torus","R":3,"r":1}]}"#,
        Format::Json,
    ),
    (
        "title {t}\nput {a b} ell V {0 0 0} A {5 0 0} B {0 5 0} C {0 0 5}\nput r tgc V {0 0 -9} H {0 0 18} A {2 0 0} B {0 2 0} C {2 0 0} D {0 2 0}\nput w arb8 V1 {0 0 0} V2 {6 0 0} V3 {6 4 0} V4 {0 4 0} V5 {0 0 3} V6 {6 0 3} V7 {6 0 3} V8 {0 0 3}\nput t tor V {0 0 5} H {0 1 0} r_a 7 r_h 2\nput c comb region yes tree {u {- {l {a b}} {l r {1 0 0 1  0 1 0 0  0 0 1 0  0 0 0 1}}} {n {l t} {l w}}}\n",
        Format::Asc,
    ),
    (
        "#include \"a.inc\" #declare R = 2 + .5; /* c */ camera { location 0 }\n#declare B = box { 0, 1 scale <1,2,3> }\ndifference { sphere { <1,2,3>*R, R } object { B rotate 30*y } cylinder { -x, x, 1 inverse } torus { 3, 1 } texture { pigment { color rgb 1 } } translate R*y }",
        Format::Pov,
    ),
];

/// Reads, and checks that an error's span is in the text.
fn check(bytes: &[u8], format: Format) {
    if let Err(error) = read("part", bytes, format, &ReadOptions::default()) {
        assert!(error.span.start <= error.span.end && error.span.end <= bytes.len());
        assert!(error.line >= 1 && error.column >= 1);
        assert!(!error.to_string().is_empty());
    }
}

proptest! {
    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        for format in Format::ALL {
            check(&bytes, format);
        }
    }

    #[test]
    fn words_in_any_order(words in prop::collection::vec(prop::sample::select(vec![
        "A", "=", "BLO", "SPH", "AT", "UN", "DIF", "(", ")", ",", "X", "R", "ROTX", "1", "-", "*", "/", "\n",
        "cube", "group", "{", "}", ";", "[", "]", "multmatrix", "%", "!", "$fn", "circle", "undef", "nan",
        "\"op\"", "\"prim\"", "\"union\"", ":", "null", "\"", "#", "0", "1e400", "1e999999999999",
        "put", "tor", "comb", "tree", "{l A}", " ", "V {0 0 0}", "<", ">", "object", "sphere", "#declare", "scale",
        "difference", "inverse", ".x", "FOR", " i=0..3", "..", "STEP", "H(D)=", "H(", "D=", "sin(", "sqrt(", "min(", "pi", "INCLUDE",
        "\"a.padl\"", "HALF(", "OUT(",
    ]), 0..60)) {
        let text = words.concat();
        for format in Format::ALL {
            check(text.as_bytes(), format);
        }
    }

    #[test]
    fn changed_files(
        seed in 0..SEEDS.len(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), 0u8..3, any::<u8>()), 1..8),
    ) {
        let (text, format) = SEEDS[seed];
        let mut bytes = text.as_bytes().to_vec();
        for (place, kind, byte) in changes {
            let at = place.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte % 128),
                _ => {
                    bytes.remove(at);
                }
            }
        }
        check(&bytes, format);
    }
}

#[test]
fn the_seeds_are_good() {
    for (text, format) in SEEDS {
        tree(text, format);
    }
}

const DEEP: usize = 100_000;

fn nested(open: &str, middle: &str, close: &str) -> String {
    [open.repeat(DEEP).as_str(), middle, &close.repeat(DEEP)].concat()
}

#[test]
fn deep_padl() {
    let text = format!("A = {}", nested("(", "SPH(R=1)", ")"));
    assert_eq!(tree(&text, Format::Padl).leaves().count(), 1);
    let text = format!("A = SPH(R={})", nested("-(", "1", ")"));
    assert_eq!(tree(&text, Format::Padl).leaves().count(), 1);
    let text = format!("A = {}", nested("(", "SPH(R=1)", ") AT (MOVX=1)"));
    assert_eq!(tree(&text, Format::Padl).leaves().count(), 1);
    let text = format!("A = {}", "(".repeat(DEEP));
    assert!(read_text(&text, Format::Padl).is_err());
}

#[test]
fn deep_padl_loops_and_parts() {
    let inner = nested("(FOR i=0..0: ", "SPH(R=1)", ")");
    assert!(read_text(&format!("A = {inner}"), Format::Padl).is_err());
    for open in [
        "FOR i=",
        "(FOR i=(",
        "FOR i=0..",
        "sin(",
        "min(1,",
        "H(",
        "H(D=",
    ] {
        let text = format!("H(D) = SPH(R=D)\nA = {}", open.repeat(DEEP));
        assert!(read_text(&text, Format::Padl).is_err());
    }
    let text = format!("H(D) = D\nA = SPH(R={})", nested("H(", "1", ")"));
    assert_eq!(tree(&text, Format::Padl).leaves().count(), 1);
    let text = format!("A = SPH(R={})", nested("max(", "1", ")"));
    assert_eq!(tree(&text, Format::Padl).leaves().count(), 1);
    // A chain of parts, each of which uses the one before.
    let chain = (1..LEVELS).map(|k| format!("H{k}(D) = H{}(D)\n", k - 1));
    let text = format!("H0(D) = SPH(R=D)\n{}", chain.collect::<String>());
    let text = format!("{text}P = H{}(2)\n", LEVELS - 1);
    assert_eq!(tree(&text, Format::Padl).leaves().count(), 1);
}

#[test]
fn deep_csg() {
    assert_eq!(
        tree(&nested("group(){", "cube(1);", "}"), Format::Csg)
            .leaves()
            .count(),
        1
    );
    assert_eq!(
        tree(&nested("group()", "cube(1);", ""), Format::Csg)
            .leaves()
            .count(),
        1
    );
    assert!(read_text(&nested("group(){", "", ""), Format::Csg).is_err());
    assert!(read_text(&nested("cube([", "", ""), Format::Csg).is_err());
    assert!(read_text(&format!("cube({}", "[".repeat(DEEP)), Format::Csg).is_err());
}

#[test]
fn deep_json() {
    let open = r#"{"op":"union","children":["#;
    let text = nested(open, r#"{"prim":"sphere","r":1}"#, "]}");
    assert_eq!(tree(&text, Format::Json).leaves().count(), 1);
    assert!(read_text(&nested("[", "", "]"), Format::Json).is_err());
    assert!(read_text(&"[".repeat(DEEP), Format::Json).is_err());
}

#[test]
fn deep_asc() {
    let solid = "put s ell V {0 0 0} A {1 0 0} B {0 1 0} C {0 0 1}\n";
    let deep = nested("{u {l s} ", "{l s}", "}");
    let text = format!("{solid}put c comb tree {deep}\n");
    assert_eq!(tree(&text, Format::Asc).leaves().count(), DEEP + 1);
    // Each combination uses the one before twice: copies have a limit.
    let doubled =
        (1..40).map(|k| format!("put c{k} comb tree {{u {{l c{0}}} {{l c{0}}}}}\n", k - 1));
    let text = format!(
        "{solid}put c0 comb tree {{l s}}\n{}",
        doubled.collect::<String>()
    );
    assert!(read_text(&text, Format::Asc).is_err());
    let text = format!("{solid}put c comb tree {}\n", "{".repeat(DEEP));
    assert!(read_text(&text, Format::Asc).is_err());
    // A combination of one member for each level.
    let chain = (1..LEVELS).map(|k| format!("put c{k} comb tree {{l c{}}}\n", k - 1));
    let text = format!(
        "{solid}put c0 comb tree {{l s}}\n{}",
        chain.collect::<String>()
    );
    assert_eq!(tree(&text, Format::Asc).leaves().count(), 1);
}

#[test]
fn deep_pov() {
    let text = nested("union{", "sphere{0,1}", "}");
    assert_eq!(tree(&text, Format::Pov).leaves().count(), 1);
    for open in [
        "union{",
        "(",
        "sphere{(",
        "object{",
        "/*",
        "sphere{<",
        "#declare A=union{",
    ] {
        assert!(read_text(&open.repeat(DEEP), Format::Pov).is_err());
    }
    let text = format!("sphere{{0,{}1}}", "-".repeat(2 * DEEP));
    assert_eq!(tree(&text, Format::Pov).leaves().count(), 1);
}

const LEVELS: usize = 50_000;

#[test]
fn deep_trees_of_alternating_operations() {
    let open = "union(){cube(1);intersection(){cube(2);multmatrix([[1,0,0,1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]){";
    let text = [
        open.repeat(LEVELS).as_str(),
        "cube(3);",
        &"}}}".repeat(LEVELS),
    ]
    .concat();
    assert_eq!(tree(&text, Format::Csg).leaves().count(), 2 * LEVELS + 1);
}
