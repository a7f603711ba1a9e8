//! Sheets of several views.

use crate::{Camera, Result, Solid};
use premio_drawing::DrawingOptions;
use premio_drawing::sheet::{Sheet, SheetOptions, SheetView, StandardView};
use premio_kernel::concurrency;

impl Solid {
    /// Several standard views on one sheet, placed as ISO 5456-2 has it, each once.
    ///
    /// Write the sheet with [`sheet_to_svg`](crate::sheet_to_svg) or
    /// [`sheet_to_dxf`](crate::sheet_to_dxf).
    ///
    /// # Errors
    /// As [`Solid::view`]; or the views do not fit on the sheet at the scale.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(60, 40, 20).evaluate()?;
    /// let views = [StandardView::Front, StandardView::Top, StandardView::Isometric];
    /// let sheet = solid.sheet(&views, &DrawingOptions::default(), SheetOptions::new("plate"))?;
    /// assert!(premio::sheet_to_svg(&sheet).contains("plate"));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn sheet(
        &self,
        views: &[StandardView],
        drawing: &DrawingOptions,
        options: SheetOptions,
    ) -> Result<Sheet> {
        let mut different: Vec<StandardView> = Vec::new();
        for &view in views {
            if !different.contains(&view) {
                different.push(view);
            }
        }
        let drawings = concurrency::map(&different, 1, |&view| {
            let seen = self.view(&Camera::standard(view))?;
            Ok(SheetView {
                view: Some(view),
                drawing: seen.drawing(drawing),
            })
        });
        let drawings = drawings.into_iter().collect::<Result<_>>()?;
        Ok(Sheet::new(drawings, options)?)
    }
}
