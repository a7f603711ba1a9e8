//! Divides seams where two of them cross, and where a seam would end where it starts.

use super::{Cut, End, Seam};
use std::f64::consts::TAU;

impl Cut {
    /// Splits a seam from pole to pole in the middle. Where both poles are one point, readers cannot
    /// distinguish a full turn from an edge of length zero.
    pub(super) fn split_between_poles(&mut self) {
        let is_whole = |seam: &Seam| seam.ends.iter().all(|end| matches!(end, End::Pole(_)));
        let Some(at) = self.seams.iter().position(is_whole) else {
            return;
        };
        let seam = self.seams.remove(at);
        let ([lo, hi], [from, to]) = (seam.range, seam.ends);
        let middle = 0.5 * (lo + hi);
        self.seams.push(Seam {
            range: [lo, middle],
            ends: [from, End::Crossing],
            ..seam.clone()
        });
        self.seams.push(Seam {
            range: [middle, hi],
            ends: [End::Crossing, to],
            ..seam
        });
    }

    /// Splits the pieces of both seams where they cross.
    pub(super) fn split_at_crossing(&mut self) {
        let v = self.window.starts[1];
        // Along one seam the other angle is the curve's parameter.
        let at = [v, 0.0];
        let passes = |seam: &Seam| {
            let [lo, hi] = seam.range;
            let t = lo + (at[seam.across] - lo).rem_euclid(TAU);
            (t < hi || seam.ends == [End::Crossing; 2]).then_some(t)
        };
        let both = |i: usize| {
            self.seams
                .iter()
                .any(|s| s.across == i && passes(s).is_some())
        };
        if !(both(0) && both(1)) {
            return;
        }
        let seams = std::mem::take(&mut self.seams);
        for seam in seams {
            let [lo, hi] = seam.range;
            match passes(&seam) {
                None => self.seams.push(seam),
                Some(t) if seam.ends == [End::Crossing; 2] => self.seams.push(Seam {
                    range: [t, t + TAU],
                    ..seam
                }),
                Some(t) => {
                    let [from, to] = seam.ends;
                    self.seams.push(Seam {
                        range: [lo, t],
                        ends: [from, End::Crossing],
                        ..seam.clone()
                    });
                    self.seams.push(Seam {
                        range: [t, hi],
                        ends: [End::Crossing, to],
                        ..seam
                    });
                }
            }
        }
    }
}
