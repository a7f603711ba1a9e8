//! Remarks for the author, and the noise of a text's numbers.

use std::ops::Range;

use super::Note;

/// Collects remarks. Remarks of a kind that any node may cause are counted, and made once.
#[derive(Debug)]
pub(super) struct Notes {
    notes: Vec<Note>,
    /// Rotations that were replaced by exact ones.
    rotations: Repeated,
    /// The largest change of their entries.
    residual: f64,
    /// Polyhedra with faces that are not plane.
    polyhedra: Repeated,
    /// The number of these faces.
    faces: usize,
    /// The noise implied by any number that is replaced.
    least: f64,
}

/// Remarks of one kind.
#[derive(Debug, Default)]
struct Repeated {
    count: usize,
    /// The place of the first one in the text and among the remarks.
    first: Option<(Range<usize>, usize)>,
}

impl Repeated {
    fn add(&mut self, span: Range<usize>, after: usize) {
        self.count += 1;
        self.first.get_or_insert((span, after));
    }
}

/// The remarks on a text.
pub(super) struct Remarks {
    /// The noise of the coordinates, if any.
    pub digits: Option<f64>,
    pub notes: Vec<Note>,
}

impl Notes {
    /// No remarks yet. `least` is the noise of the text's numbers, should any have to be replaced.
    pub(super) fn of_digits(least: f64) -> Self {
        Self {
            notes: Vec::new(),
            rotations: Repeated::default(),
            residual: 0.0,
            polyhedra: Repeated::default(),
            faces: 0,
            least,
        }
    }

    /// Adds a remark.
    pub(super) fn add(&mut self, text: impl Into<String>, span: Range<usize>) {
        let text = text.into();
        self.notes.push(Note { text, span });
    }

    /// Records that a rotation was replaced by an exact one, with entries changed by up to
    /// `residual`.
    pub(super) fn snapped(&mut self, residual: f64, span: Range<usize>) {
        self.rotations.add(span, self.notes.len());
        self.residual = self.residual.max(residual);
    }

    /// Records that faces of a polyhedron are not plane.
    pub(super) fn triangulated(&mut self, faces: usize, span: Range<usize>) {
        self.polyhedra.add(span, self.notes.len());
        self.faces += faces;
    }

    /// All remarks.
    pub(super) fn finish(mut self) -> Remarks {
        let (rotations, polyhedra) = (self.rotations.count, self.polyhedra.count);
        let changed = format!("entries change by up to {:.1e}", self.residual);
        let exact = match rotations {
            1 => format!("read as the nearest exact rotation; {changed}"),
            _ => format!("{rotations} matrices are read as the nearest exact rotations; {changed}"),
        };
        let of = match polyhedra {
            1 => "a polyhedron".to_owned(),
            _ => format!("{polyhedra} polyhedra"),
        };
        let cut = match self.faces {
            1 => format!("1 face of {of} is not plane, and was cut into triangles"),
            faces => format!("{faces} faces of {of} are not plane, and were cut into triangles"),
        };
        let counted = [(self.rotations.first, exact), (self.polyhedra.first, cut)];
        let mut counted: Vec<(usize, Note)> = counted
            .into_iter()
            .filter_map(|(first, text)| {
                let (span, after) = first?;
                Some((after, Note { text, span }))
            })
            .collect();
        counted.sort_by_key(|(after, note)| (*after, note.span.start));
        for (after, note) in counted.into_iter().rev() {
            self.notes.insert(after, note);
        }
        Remarks {
            digits: (rotations > 0).then(|| self.least.max(self.residual)),
            notes: self.notes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Notes;

    fn texts(notes: Notes) -> Vec<String> {
        let notes = notes.finish().notes.into_iter();
        notes.map(|note| note.text).collect()
    }

    #[test]
    fn a_rotation_has_its_own_remark() {
        let mut notes = Notes::of_digits(1e-6);
        notes.snapped(2e-7, 3..4);
        let remark = "read as the nearest exact rotation; entries change by up to 2.0e-7";
        assert_eq!(texts(notes), [remark]);
    }

    #[test]
    fn repeated_remarks_are_counted_at_the_first_place() {
        let mut notes = Notes::of_digits(1e-6);
        notes.add("first", 0..1);
        notes.triangulated(2, 5..6);
        notes.snapped(2e-7, 3..4);
        notes.add("last", 8..9);
        notes.snapped(4e-7, 9..10);
        notes.triangulated(1, 9..10);
        let remarks = [
            "first",
            "2 matrices are read as the nearest exact rotations; entries change by up to 4.0e-7",
            "3 faces of 2 polyhedra are not plane, and were cut into triangles",
            "last",
        ];
        assert_eq!(texts(notes), remarks);
    }

    #[test]
    fn replaced_numbers_have_noise() {
        assert_eq!(Notes::of_digits(1e-6).finish().digits, None);
        let mut notes = Notes::of_digits(1e-6);
        notes.snapped(2e-5, 3..4);
        assert_eq!(notes.finish().digits, Some(2e-5));
    }
}
