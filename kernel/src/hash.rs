//! Hash maps and sets for indices and coordinates. Their hash function is faster than the standard one.
//! Every map has a random seed, which makes collisions hard to provoke.

use foldhash::fast::RandomState;

/// A hash map. Start with `HashMap::default()`.
pub type HashMap<K, V> = std::collections::HashMap<K, V, RandomState>;

/// A hash set. Start with `HashSet::default()`.
pub type HashSet<K> = std::collections::HashSet<K, RandomState>;
