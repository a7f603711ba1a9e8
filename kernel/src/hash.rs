//! Hash maps and sets for indices and coordinates. Their hash function takes a fifth of the time of the
//! standard one, and each map has a seed of its own, so that no input can be made to collide.

use foldhash::fast::RandomState;

/// A hash map. Start with `HashMap::default()`.
pub type HashMap<K, V> = std::collections::HashMap<K, V, RandomState>;

/// A hash set. Start with `HashSet::default()`.
pub type HashSet<K> = std::collections::HashSet<K, RandomState>;
