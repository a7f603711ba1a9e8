//! The columns of a model's table.

use super::TableError;
use ColumnKind::{Real, Reals, Text, Whole, Wholes};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::file::writer::SerializedColumnWriter;
use serde_json::Value;

/// The type of a column's cells, which may be null.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// A text.
    Text,
    /// A whole number.
    Whole,
    /// A double.
    Real,
    /// A list of whole numbers.
    Wholes,
    /// A list of f64 values; of a matrix row by row.
    Reals,
}

/// A column: its name, its type, and the pointer of its value in a row's JSON.
#[derive(Clone, Copy, Debug)]
pub struct Column(pub &'static str, pub ColumnKind, pub &'static str);

/// All columns; a row has values of those that belong to its `record`.
#[rustfmt::skip]
pub const COLUMNS: &[Column] = &[
    Column("record", Text, "/record"),
    Column("rank", Whole, "/rank"),
    // Of the features of an aspect: the ranks of both.
    Column("aspect", Whole, "/aspect"),
    Column("feature", Whole, "/feature"),
    Column("source", Text, "/source/kind"),
    Column("edge", Whole, "/source/edge"),
    Column("face", Whole, "/source/face"),
    Column("ordinal", Whole, "/source/ordinal"),
    Column("light", Whole, "/source/light"),
    Column("caster", Whole, "/source/caster"),
    Column("whole", Whole, "/states/0"),
    Column("broken", Whole, "/states/1"),
    Column("missed", Whole, "/states/2"),
    Column("detectability", Real, "/detectability/mean"),
    Column("detectability_low", Real, "/detectability/interval/0"),
    Column("detectability_high", Real, "/detectability/interval/1"),
    Column("detectability_of", Whole, "/detectability/of"),
    Column("detectability_visible", Real, "/detectability_visible/mean"),
    Column("detectability_visible_low", Real, "/detectability_visible/interval/0"),
    Column("detectability_visible_high", Real, "/detectability_visible/interval/1"),
    Column("detectability_visible_of", Whole, "/detectability_visible/of"),
    Column("reliability", Real, "/reliability/mean"),
    Column("reliability_low", Real, "/reliability/interval/0"),
    Column("reliability_high", Real, "/reliability/interval/1"),
    Column("reliability_of", Whole, "/reliability/of"),
    Column("accuracy_turn", Real, "/accuracy/0"),
    Column("accuracy_move", Real, "/accuracy/1"),
    Column("fragments", Wholes, "/fragments"),
    Column("share", Real, "/share"),
    Column("attributes_count", Whole, "/attributes/count"),
    Column("attributes_mean", Reals, "/attributes/mean"),
    Column("attributes_covariance", Reals, "/attributes/covariance"),
    // The co-detection of features.
    Column("parent", Whole, "/together/parent"),
    Column("information", Real, "/together/information"),
    Column("marginal", Reals, "/together/marginal"),
    Column("table", Reals, "/together/table"),
    // Of aspects.
    Column("setups", Whole, "/setups"),
    Column("view", Reals, "/view"),
    // Of relations.
    Column("relation", Text, "/kind"),
    Column("members", Wholes, "/members"),
    Column("count_visible", Whole, "/counts/0"),
    Column("count_seen", Whole, "/counts/1"),
    Column("count_kept", Whole, "/counts/2"),
    Column("kept", Real, "/kept/mean"),
    Column("kept_low", Real, "/kept/interval/0"),
    Column("kept_high", Real, "/kept/interval/1"),
    Column("kept_of", Whole, "/kept/of"),
    Column("chance", Real, "/chance"),
];

impl Column {
    /// Its line in the schema.
    pub fn field(&self) -> String {
        let Self(name, kind, _) = self;
        let list = |of: &str| {
            format!(
                "OPTIONAL group {name} (LIST) {{ REPEATED group list {{ REQUIRED {of} element; }} }} "
            )
        };
        match kind {
            Text => format!("OPTIONAL BYTE_ARRAY {name} (UTF8); "),
            Whole => format!("OPTIONAL INT64 {name}; "),
            Real => format!("OPTIONAL DOUBLE {name}; "),
            Wholes => list("INT64"),
            Reals => list("DOUBLE"),
        }
    }

    /// Writes its cells of all rows.
    pub fn write(
        &self,
        rows: &[Value],
        to: &mut SerializedColumnWriter<'_>,
    ) -> Result<(), TableError> {
        match self.1 {
            Text => self.typed::<ByteArrayType>(rows, to, |v| Some(ByteArray::from(v.as_str()?))),
            Whole | Wholes => self.typed::<Int64Type>(rows, to, Value::as_i64),
            // JSON has no numbers that are not finite.
            Real | Reals => self.typed::<DoubleType>(rows, to, |v| match v {
                Value::Null => Some(f64::NAN),
                v => v.as_f64(),
            }),
        }
    }

    fn typed<T: DataType>(
        &self,
        rows: &[Value],
        to: &mut SerializedColumnWriter<'_>,
        read: impl Fn(&Value) -> Option<T::T>,
    ) -> Result<(), TableError> {
        let mut cells = Cells::default();
        rows.iter().for_each(|row| cells.push(self, row));
        let found = |value: &&Value| {
            read(value).ok_or_else(|| TableError::Cell {
                column: self.0,
                found: (*value).clone(),
            })
        };
        let values: Vec<T::T> = cells.values.iter().map(found).collect::<Result<_, _>>()?;
        let repeated = matches!(self.1, Wholes | Reals).then_some(&cells.repeated[..]);
        to.typed::<T>()
            .write_batch(&values, Some(&cells.defined), repeated)?;
        Ok(())
    }
}

/// The values of a column, with the levels by which Parquet encodes nulls and the beginnings of
/// lists.
#[derive(Default)]
struct Cells<'r> {
    values: Vec<&'r Value>,
    /// The definition level: 0 is null; of lists 1 is empty, and 2 a value.
    defined: Vec<i16>,
    /// The repetition level: 0 begins a row, 1 continues its list.
    repeated: Vec<i16>,
}

impl<'r> Cells<'r> {
    fn push(&mut self, column: &Column, row: &'r Value) {
        let cell = row.pointer(column.2).filter(|v| !v.is_null());
        let is_list = matches!(column.1, Wholes | Reals);
        let before = self.values.len();
        match cell {
            Some(list) if is_list => leaves(list, &mut self.values),
            cell => self.values.extend(cell),
        }
        let count = self.values.len() - before;
        if count == 0 {
            self.defined.push(i16::from(cell.is_some()));
            self.repeated.push(0);
        }
        self.defined
            .extend((0..count).map(|_| if is_list { 2 } else { 1 }));
        self.repeated.extend((0..count).map(|i| i16::from(i > 0)));
    }
}

/// The values of a list, or of a matrix row by row.
fn leaves<'v>(list: &'v Value, to: &mut Vec<&'v Value>) {
    for item in list.as_array().into_iter().flatten() {
        match item.as_array() {
            Some(row) => to.extend(row),
            None => to.push(item),
        }
    }
}
