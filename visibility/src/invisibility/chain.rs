//! A contour arc cut at its junctions.
//!
//! Junctions that follow one another within the tolerance are one cut: between them nothing is
//! resolved, so what happens at each of them is not carried across.

use crate::contour_generator::contour_arc::{Change, ContourArc};
use crate::contour_generator::junctions::Junctions;
use premio_kernel::number::predicates::Compare;

/// A part of an arc between two cuts.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// The range of the parameter, from cut to cut.
    pub range: [f64; 2],
    /// The same between the last junction of the first cut and the first junction of the second.
    pub clear: [f64; 2],
    /// The junctions at both ends.
    pub ends: [Option<u32>; 2],
}

/// An arc cut into spans, and what happens between each and the next.
pub struct Chain {
    /// The spans, in order.
    pub spans: Vec<Span>,
    /// The changes between each span and the next.
    pub between: Vec<Change>,
}

/// Where an arc is cut: at one junction, or at several within the tolerance.
#[derive(Clone, Copy, Debug)]
struct Cut {
    /// The parameter that stands for all of them.
    t: f64,
    /// The junction that stands for all of them.
    junction: Option<u32>,
    /// The parameters of the first and the last of them.
    extent: [f64; 2],
    /// What happens there.
    change: Change,
}

impl Cut {
    /// An end of an arc.
    fn end(t: f64, junction: Option<u32>) -> Self {
        let (extent, change) = ([t, t], Change::Correct);
        Self {
            t,
            junction,
            extent,
            change,
        }
    }
}

impl Chain {
    /// Cuts an arc at its splits and sorts these. Junctions of one cut become ambiguous.
    pub fn new(arc: &mut ContourArc<'_>, junctions: &mut Junctions<'_>, tolerance: f64) -> Self {
        arc.splits.sort_by(|a, b| a.t.total_cmp(&b.t));
        let arc = &*arc;
        let mut cutter = Cutter {
            arc,
            junctions,
            tolerance,
            cuts: Vec::with_capacity(arc.splits.len() + 2),
        };
        cutter.cut();
        let cuts = cutter.cuts;
        if cuts.is_empty() {
            let whole = Span {
                range: arc.range,
                clear: arc.range,
                ends: arc.ends,
            };
            return Self {
                spans: vec![whole],
                between: Vec::new(),
            };
        }
        let spans: Vec<Span> = cuts
            .windows(2)
            .map(|pair| Span {
                range: [pair[0].t, pair[1].t],
                clear: [pair[0].extent[1], pair[1].extent[0]],
                ends: [pair[0].junction, pair[1].junction],
            })
            .collect();
        let inner = cuts.get(1..cuts.len() - 1).unwrap_or_default();
        let mut between: Vec<Change> = inner.iter().map(|cut| cut.change).collect();
        // Contours that are not apart by the time of the next junction are not passed clearly.
        for (around, change) in spans.windows(2).zip(&mut between) {
            let at = around[0].range[1];
            let way = (at - around[0].clear[0]).min(around[1].clear[1] - at) * arc.curve.speed(at);
            if matches!(change, Change::Pass(passing) if (way * passing.lateral).is_at_most(tolerance))
            {
                *change = Change::Correct;
            }
        }
        Self { spans, between }
    }
}

/// Cuts one arc.
struct Cutter<'c, 'a, 'j, 'p> {
    arc: &'c ContourArc<'a>,
    junctions: &'j mut Junctions<'p>,
    tolerance: f64,
    /// In order, with the ends of an open arc, and with the first again at the end of a closed one.
    cuts: Vec<Cut>,
}

impl Cutter<'_, '_, '_, '_> {
    fn cut(&mut self) {
        let [lo, hi] = self.arc.range;
        if !self.arc.closed {
            self.cuts.push(Cut::end(lo, self.arc.ends[0]));
        }
        for split in &self.arc.splits {
            let cut = Cut {
                change: split.change,
                ..Cut::end(split.t, Some(split.junction))
            };
            match self.cuts.last().copied() {
                Some(last) if self.are_one(last.extent[1], cut.t) => {
                    self.mark_ambiguous([last, cut]);
                    self.join_to_last(cut);
                }
                _ => self.cuts.push(cut),
            }
        }
        match self.arc.closed {
            true => self.close(hi - lo),
            false => self.end(Cut::end(hi, self.arc.ends[1])),
        }
    }

    /// Whether two parameters are of one point, within the tolerance.
    fn are_one(&self, s: f64, t: f64) -> bool {
        let apart = (t - s).abs() * self.arc.curve.speed(t);
        s.is_exactly(t) || apart.is_at_most(self.tolerance)
    }

    fn mark_ambiguous(&mut self, cuts: [Cut; 2]) {
        for id in cuts.into_iter().filter_map(|cut| cut.junction) {
            self.junctions.mark_ambiguous(id);
        }
    }

    fn join_to_last(&mut self, cut: Cut) {
        if let Some(last) = self.cuts.last_mut() {
            last.extent[1] = cut.extent[1];
            last.change = Change::Correct;
        }
    }

    /// Adds the end of an open arc, which stands for the junctions next to it.
    fn end(&mut self, end: Cut) {
        let Some(before) = self.cuts.last().copied() else {
            return;
        };
        let alone = before.extent[0].is_exactly(before.extent[1]);
        let is_start = self.cuts.len() == 1;
        if !self.are_one(end.t, before.extent[1]) || (is_start && alone) {
            return self.cuts.push(end);
        }
        self.mark_ambiguous([before, end]);
        self.cuts.pop();
        if is_start {
            // All junctions lie next to both ends: these alone bound the one span.
            let extent = [before.t; 2];
            self.cuts.extend([Cut { extent, ..before }, end]);
        } else {
            let extent = [before.extent[0], end.t];
            self.cuts.push(Cut { extent, ..end });
        }
    }

    /// Adds the first cut of a closed arc again, a period later.
    fn close(&mut self, period: f64) {
        let (Some(first), Some(last)) = (self.cuts.first().copied(), self.cuts.last().copied())
        else {
            return;
        };
        let mut first = first;
        if self.cuts.len() > 1 && self.are_one(first.extent[0] + period, last.extent[1]) {
            self.mark_ambiguous([last, first]);
            self.cuts.pop();
            first.extent[0] = last.extent[0] - period;
            first.change = Change::Correct;
            self.cuts[0] = first;
        }
        self.cuts.push(Cut {
            t: first.t + period,
            extent: first.extent.map(|t| t + period),
            ..first
        });
    }
}
