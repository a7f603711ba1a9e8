//! The steps of the detector.

use super::corners::{corners, extend};
use super::detection::Detection;
use super::grey::Grey;
use super::joining::join;
use super::linking::link;
use super::parameters::Detector;
use super::pixel_mask::PixelMask;
use super::segments::Fitter;
use super::shrink::shrink;
use super::thinning::{connect, edge_pixels, pick};
use super::workspace::Workspace;

impl Detector {
    /// Finds the edges in the known pixels of an image. Nothing is found where image and domain are
    /// of different sizes.
    pub fn detect(&self, grey: &Grey, domain: &PixelMask) -> Detection {
        self.detect_with(&mut Workspace::new(), grey, domain)
    }

    /// Finds the edges in reused memory.
    pub fn detect_with(&self, work: &mut Workspace, grey: &Grey, domain: &PixelMask) -> Detection {
        let size = grey.width.checked_mul(grey.height);
        let usable = size.is_some_and(|n| n == grey.levels.len() && u32::try_from(n).is_ok());
        if !usable || [domain.width(), domain.height()] != [grey.width, grey.height] {
            return Detection::default();
        }
        work.resize(grey.width, grey.height);
        let inner = domain.eroded(self.mask.radius());
        work.gradient.find(self.mask, grey, domain, &inner);
        pick(self, work, &inner.eroded(1));
        connect(self, work);
        shrink(self.thinning, work);
        let links = link(work);
        let pixels = edge_pixels(self, work);
        work.clear();
        let chains = join(links.chains(&pixels), &pixels, self);
        let mut fitter = Fitter::new(self, &pixels);
        let chains = fitter.segments(chains);
        let mut segments = fitter.found;
        let corners = corners(self, &pixels, &chains, &segments);
        extend(self, &corners, &mut segments);
        Detection {
            pixels,
            chains,
            segments,
            corners,
        }
    }
}
