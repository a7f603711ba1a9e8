//! The cycle space of a graph.
//!
//! The loops of a face are found from the order of edges around vertices. Here they are checked to
//! be sums (modulo two) of cycles of its boundary. A cycle basis (Welch, J. ACM 13(2), 1966) spans
//! exactly the sets of edges in which every vertex has an even degree (Veblen 1912), so that the
//! degrees decide. Gibbs (1969) showed that Welch's enumeration of all cycles from a basis is wrong;
//! it is not needed.

/// An edge of the graph between two vertices; an edge from a vertex to itself is a cycle.
pub type GraphEdge = [usize; 2];

/// Whether a list of edges is a sum of cycles. An edge that occurs twice cancels itself.
pub fn is_sum_of_cycles(edges: &[GraphEdge]) -> bool {
    let mut ends: Vec<usize> = edges.iter().flatten().copied().collect();
    ends.sort_unstable();
    let mut by_vertex = ends.chunk_by(|a, b| a == b);
    by_vertex.all(|degree| degree.len().is_multiple_of(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cycles_of_a_square_with_a_diagonal_are_sums() {
        let [ab, bc, cd, da, ac] = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]];
        assert!(is_sum_of_cycles(&[ab, bc, cd, da]));
        assert!(is_sum_of_cycles(&[ab, bc, ac]));
        assert!(!is_sum_of_cycles(&[ab, bc, cd]));
        assert!(is_sum_of_cycles(&[ab, bc, ac, cd, cd]));
    }

    #[test]
    fn an_edge_from_a_vertex_to_itself_is_a_cycle() {
        assert!(is_sum_of_cycles(&[[5, 5]]));
        assert!(!is_sum_of_cycles(&[[5, 5], [5, 6]]));
    }
}
