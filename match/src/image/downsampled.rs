//! Reduction of large images to the size for which detectors and distances in pixels are set.

use crate::camera::Pinhole;
use premio_detect::Grey;

/// The longest side of an image, in pixels; larger ones are halved.
const LONGEST: usize = 1280;

/// A reduced image.
#[derive(Clone, Debug)]
pub struct DownsampledImage {
    /// The image.
    pub grey: Grey,
    /// Its camera.
    pub camera: Pinhole,
    /// The factor of the reduction: one, two, four and so on.
    pub scale: u32,
}

/// The image halved until its longer side is at most `LONGEST`.
pub fn downsampled(grey: Grey, camera: Pinhole) -> DownsampledImage {
    let (mut grey, mut camera, mut scale) = (grey, camera, 1);
    while grey.width.max(grey.height) > LONGEST {
        grey = halved(&grey);
        camera = camera.halved();
        scale *= 2;
    }
    DownsampledImage {
        grey,
        camera,
        scale,
    }
}

/// The image of the means of 2 × 2 pixels. An odd last column or row is cut off.
fn halved(grey: &Grey) -> Grey {
    let level = |x: usize, y: usize| {
        let at = |dx: usize, dy: usize| grey.levels[(2 * y + dy) * grey.width + 2 * x + dx];
        0.25 * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1))
    };
    Grey::new(grey.width / 2, grey.height / 2, level)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    /// The image of a point lies in the reduced pixel that contains the original one.
    #[test]
    fn the_camera_shrinks_with_the_picture() {
        let camera = Pinhole {
            focal: [3000.0, 3100.0],
            centre: [2000.0, 1499.0],
            skew: 2.0,
        };
        let grey = Grey::new(4000, 3001, |x, y| ((x + 2 * y) % 251) as f32);
        let DownsampledImage {
            grey: small,
            camera: near,
            scale,
        } = downsampled(grey, camera);
        assert_eq!((small.width, small.height, scale), (1000, 750, 4));
        for p in [[0.1, 0.2, 2.0], [-0.5, 0.3, 1.5], [0.0, 0.0, 1.0]] {
            let p = Point3::from(p);
            let (before, after) = (camera.project(&p), near.project(&p));
            for i in 0..2 {
                assert!((4.0 * (after[i] + 0.5) - 0.5 - before[i]).abs() < 1e-9);
            }
        }
        let same = downsampled(small.clone(), near);
        assert_eq!((same.grey, same.camera, same.scale), (small, near, 1));
    }
}
