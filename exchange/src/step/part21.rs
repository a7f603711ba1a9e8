//! The clear text of ISO 10303-21: numbered instances of entities.

use super::{Protocol, StepOptions};
use premio_text::escape;
use std::fmt::Write as _;

/// The number of an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Id(u32);

impl std::fmt::Display for Id {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{}", self.0)
    }
}

/// The instances written so far.
#[derive(Debug, Default)]
pub(super) struct Exchange {
    data: String,
    last: u32,
}

impl Exchange {
    /// Adds an instance.
    pub fn add(&mut self, entity: std::fmt::Arguments<'_>) -> Id {
        self.last += 1;
        // Writing to a string does not fail.
        let _ = writeln!(self.data, "#{}={entity};", self.last);
        Id(self.last)
    }

    /// The whole file.
    pub fn finish(self, options: &StepOptions) -> String {
        let schema = match options.protocol {
            Protocol::Ap242 => {
                "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }"
            }
            Protocol::Ap214 => "AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }",
        };
        // Without the time, so that equal parts give equal files.
        format!(
            "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('{name}'),'2;1');\n\
             FILE_NAME('{name}','',(''),(''),'premio {version}','premio','');\n\
             FILE_SCHEMA(('{schema}'));\nENDSEC;\nDATA;\n{data}ENDSEC;\nEND-ISO-10303-21;\n",
            name = escape::step(&options.name),
            version = env!("CARGO_PKG_VERSION"),
            data = self.data,
        )
    }
}

/// A number in the format's notation: with a point, and a capital E.
pub(super) struct Real(pub f64);

impl std::fmt::Display for Real {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let text = format!("{:?}", self.0 + 0.0);
        match text.split_once('e') {
            None => f.write_str(
                text.strip_suffix('0')
                    .filter(|t| t.ends_with('.'))
                    .unwrap_or(&text),
            ),
            Some((digits, power)) => {
                let point = if digits.contains('.') { "" } else { "." };
                write!(f, "{digits}{point}E{power}")
            }
        }
    }
}

/// Numbers in parentheses.
pub(super) struct Reals<'a>(pub &'a [f64]);

impl std::fmt::Display for Reals<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        listed(f, self.0.iter().map(|x| Real(*x)))
    }
}

/// Items in parentheses.
pub(super) struct List<'a, T>(pub &'a [T]);

impl<T: std::fmt::Display> std::fmt::Display for List<'_, T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        listed(f, self.0.iter())
    }
}

fn listed(
    f: &mut std::fmt::Formatter<'_>,
    items: impl Iterator<Item = impl std::fmt::Display>,
) -> std::fmt::Result {
    f.write_str("(")?;
    for (k, item) in items.enumerate() {
        let comma = if k == 0 { "" } else { "," };
        write!(f, "{comma}{item}")?;
    }
    f.write_str(")")
}

/// .T. or .F.
pub(super) struct Truth(pub bool);

impl std::fmt::Display for Truth {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(if self.0 { ".T." } else { ".F." })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_a_point() {
        let shown = [0.0, -0.0, 1.0, -2.5, 10.0, 1e-7, 1.25e300, -3e22, 1e21];
        let shown = shown.map(|x| Real(x).to_string());
        let expected = [
            "0.", "0.", "1.", "-2.5", "10.", "1.E-7", "1.25E300", "-3.E22", "1.E21",
        ];
        assert_eq!(shown, expected);
        assert_eq!(Reals(&[1.0, 0.5]).to_string(), "(1.,0.5)");
    }
}
