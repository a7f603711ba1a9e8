//! A part found in an image, and its pose.
//!
//! The modules are stages; data flows down the list:
//!
//! 1. [`camera`]: the pinhole camera.
//! 2. [`image`]: edges, lines and corners of an image.
//! 3. [`part`]: samples along the part's edges, its symmetries, visibility by direction and
//!    detectability.
//! 4. [`pose`]: poses from few features, and least squares on poses.
//! 5. [`hypothesis`]: poses proposed and sorted by a coarse score.
//! 6. [`correspondence`]: predicted contours and image features as an assignment problem.
//! 7. [`search`]: the best assignment by branch and bound or IDA*.
//! 8. [`verification`]: the log-likelihood ratio of a match and the evidence against it.
//! 9. [`matcher`]: a part in one image. [`tracker`]: a part in a sequence.
//! 10. [`output`]: report and explanation.

pub mod camera;
pub mod correspondence;
pub mod hypothesis;
pub mod image;
pub mod matcher;
pub mod output;
pub mod part;
pub mod pose;
pub mod search;
pub mod tracker;
pub mod verification;
