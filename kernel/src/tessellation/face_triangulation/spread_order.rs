//! An order in which the nodes of an edge are inserted.

/// The numbers below `count` by their reversed bits: an order in which each is far from those just
/// before.
pub(super) fn spread(count: usize) -> impl Iterator<Item = usize> {
    let bits = usize::BITS - count.leading_zeros();
    let reversed = move |k: usize| k.reverse_bits() >> (usize::BITS - bits);
    (0..1usize << bits)
        .map(reversed)
        .filter(move |&k| k < count)
}

#[cfg(test)]
mod tests {
    use super::spread;

    #[test]
    fn a_spread_order_has_every_number_once_and_its_neighbour_before_it() {
        for count in [1, 2, 3, 10, 64, 1000] {
            let order: Vec<usize> = spread(count).collect();
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..count).collect::<Vec<_>>());
            for (k, number) in order.iter().enumerate().skip(1) {
                assert!(order[..k].contains(&(number & (number - 1))));
            }
        }
    }
}
