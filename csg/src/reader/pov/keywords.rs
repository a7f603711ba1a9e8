//! The keywords of the scene description language that are interpreted, and those that are skipped.

/// The solids that are represented exactly.
pub(super) const SOLIDS: [&str; 11] = [
    "box",
    "sphere",
    "cylinder",
    "cone",
    "torus",
    "plane",
    "union",
    "merge",
    "intersection",
    "difference",
    "object",
];

/// Objects that are not: other primitives, or no solids.
pub(super) const NOT_OURS: [&str; 26] = [
    "bicubic_patch",
    "blob",
    "cubic",
    "disc",
    "height_field",
    "isosurface",
    "julia_fractal",
    "lathe",
    "lemon",
    "light_group",
    "mesh",
    "mesh2",
    "ovus",
    "parametric",
    "poly",
    "polygon",
    "polynomial",
    "prism",
    "quadric",
    "quartic",
    "smooth_triangle",
    "sor",
    "sphere_sweep",
    "superellipsoid",
    "text",
    "triangle",
];

/// Statements and declarations with braces that do not change a solid.
pub(super) const PASSED_OVER: [&str; 22] = [
    "background",
    "camera",
    "color_map",
    "default",
    "density",
    "finish",
    "fog",
    "global_settings",
    "interior",
    "interior_texture",
    "light_source",
    "material",
    "media",
    "normal",
    "normal_map",
    "photons",
    "pigment",
    "pigment_map",
    "rainbow",
    "sky_sphere",
    "slope_map",
    "texture",
];

/// Modifiers with braces that do not change a solid. A bounded object is used as a whole.
pub(super) const SURFACES: [&str; 10] = [
    "bounded_by",
    "finish",
    "interior",
    "interior_texture",
    "material",
    "media",
    "normal",
    "photons",
    "pigment",
    "texture",
];

/// Modifiers that do not change a solid, each optionally followed by `on` or `off`.
pub(super) const FLAGS: [&str; 10] = [
    "cutaway_textures",
    "double_illuminate",
    "hollow",
    "no_image",
    "no_radiosity",
    "no_reflection",
    "no_shadow",
    "split_union",
    "sturm",
    "uv_mapping",
];

/// Modifiers that are not supported.
pub(super) const REFUSED: [&str; 4] = ["clipped_by", "matrix", "open", "transform"];

/// The keywords of Boolean values.
pub(super) fn truth(word: &str) -> Option<bool> {
    match word {
        "on" | "true" | "yes" => Some(true),
        "off" | "false" | "no" => Some(false),
        _ => None,
    }
}

/// Whether a keyword starts an object.
pub(super) fn is_object(word: &str) -> bool {
    is_solid(word) || NOT_OURS.contains(&word)
}

/// Whether a keyword starts a solid that is represented exactly.
pub(super) fn is_solid(word: &str) -> bool {
    SOLIDS.contains(&word)
}
