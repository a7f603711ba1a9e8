//! Random trees on a half-unit grid: coplanar, tangent and coaxial cases abound.

use serde_json::{Value, json};

/// The tree of a seed, in the JSON that the reader takes: 2 to 8 primitives with lengths and
/// places on a half-unit grid, turned about the axes by multiples of 90, by 45, 30 and 17 degrees.
pub fn tree(seed: u64) -> Value {
    let mut random = Random(seed);
    let count = 2 + random.below(7);
    let mut parts: Vec<Value> = (0..count).map(|_| placed_primitive(&mut random)).collect();
    while parts.len() > 1 {
        let arity = (2 + random.below(2)).min(parts.len());
        let at = random.below(parts.len() - arity + 1);
        let children: Vec<Value> = parts.splice(at..at + arity, [Value::Null]).collect();
        parts[at] = operation(&mut random, children);
    }
    parts.pop().unwrap_or(Value::Null)
}

/// The trees that are a step simpler than this one: a child in place of its parent, a child or a
/// transform less, a motion a step shorter.
pub fn simpler(tree: &Value) -> Vec<Value> {
    let mut found = Vec::new();
    let children = tree["children"].as_array();
    found.extend(children.into_iter().flatten().cloned());
    for (i, child) in children.into_iter().flatten().enumerate() {
        let mut fewer = tree.clone();
        if let Some(list) = fewer["children"].as_array_mut()
            && list.len() > 2
        {
            list.remove(i);
            found.push(fewer);
        }
        for smaller in simpler(child) {
            let mut changed = tree.clone();
            changed["children"][i] = smaller;
            found.push(changed);
        }
    }
    let steps = tree["transform"].as_array().map_or(0, Vec::len);
    for i in 0..steps {
        let mut fewer = tree.clone();
        if let Some(list) = fewer["transform"].as_array_mut() {
            list.remove(i);
        }
        if steps == 1
            && let Some(node) = fewer.as_object_mut()
        {
            node.remove("transform");
        }
        found.push(fewer);
    }
    found
}

fn operation(random: &mut Random, children: Vec<Value>) -> Value {
    let op = random.choose(&["union", "difference", "intersection", "union", "difference"]);
    let mut node = json!({"op": op, "children": children});
    if random.below(4) == 0 {
        node["transform"] = motion(random);
    }
    node
}

fn placed_primitive(random: &mut Random) -> Value {
    let mut primitive = primitive(random);
    if random.below(5) > 0 {
        primitive["transform"] = motion(random);
    }
    primitive
}

fn primitive(random: &mut Random) -> Value {
    match random.below(7) {
        0 => json!({"prim": "wedge", "size": size(random)}),
        1 => json!({"prim": "cylinder", "r": random.half(1, 4), "h": random.half(1, 8)}),
        2 => json!({"prim": "cone", "r": random.half(1, 4), "h": random.half(1, 6)}),
        3 => frustum(random),
        4 => json!({"prim": "sphere", "r": random.half(1, 5)}),
        5 => {
            let minor = 1 + random.below(3);
            let major = minor + 1 + random.below(4);
            json!({"prim": "torus", "R": halves(major), "r": halves(minor)})
        }
        _ => json!({"prim": "block", "size": size(random)}),
    }
}

fn frustum(random: &mut Random) -> Value {
    let base = 1 + random.below(4);
    let top = (base + 1 + random.below(3)) % 5;
    json!({"prim": "frustum", "r1": halves(base), "r2": halves(top), "h": random.half(1, 6)})
}

fn size(random: &mut Random) -> [f64; 3] {
    [0; 3].map(|_| random.half(1, 8))
}

fn motion(random: &mut Random) -> Value {
    let mut steps = Vec::new();
    let axis = random.choose(&[[1, 0, 0], [0, 1, 0], [0, 0, 1]]);
    let turns = [
        None,
        None,
        None,
        Some(90),
        Some(90),
        Some(180),
        Some(45),
        Some(30),
        Some(17),
    ];
    if let Some(degrees) = random.choose(&turns) {
        let degrees = if random.below(2) == 0 {
            degrees
        } else {
            -degrees
        };
        steps.push(json!({"rotate": [axis, degrees]}));
    }
    let shift = [0; 3].map(|_| random.half(0, 8) - 2.0);
    steps.push(json!({"translate": shift}));
    Value::Array(steps)
}

fn halves(n: usize) -> f64 {
    n as f64 / 2.0
}

/// Steele, Lea and Flood's generator (2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// A number of halves from `least` to `most`.
    fn half(&mut self, least: usize, most: usize) -> f64 {
        halves(least + self.below(most - least + 1))
    }

    fn choose<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use premio_csg::reader::{Format, Options, read};

    #[test]
    fn every_seed_is_a_tree() {
        for seed in 0..500 {
            let text = tree(seed).to_string();
            let read = read("tree", text.as_bytes(), Format::Json, &Options::default());
            let leaves = read.expect(&text).tree.leaves().count();
            assert!(leaves <= 8, "{text}");
        }
    }

    #[test]
    fn simpler_trees_are_trees() {
        for seed in 0..20 {
            for smaller in simpler(&tree(seed)) {
                let text = smaller.to_string();
                assert!(text.len() < tree(seed).to_string().len());
                let read = read("tree", text.as_bytes(), Format::Json, &Options::default());
                assert!(read.is_ok(), "{text}");
            }
        }
    }

    #[test]
    fn a_seed_is_one_tree() {
        assert_eq!(tree(7), tree(7));
        assert_ne!(tree(7), tree(8));
    }
}
