//! The words of the scene description language that mean something here, and those that may be
//! passed over.

/// Solids that are exact here.
pub(super) const SOLIDS: [&str; 10] = [
    "box",
    "sphere",
    "cylinder",
    "cone",
    "torus",
    "union",
    "merge",
    "intersection",
    "difference",
    "object",
];

/// Objects that are not: no primitives of ours, or no solids.
pub(super) const NOT_OURS: [&str; 27] = [
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
    "plane",
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

/// What stands in a scene, or is declared, with braces, and changes no solid.
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

/// Modifiers of an object with braces that change no solid. What is bounded is all there.
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

/// Modifiers that change no solid, each perhaps with `on` or `off` after it.
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

/// Modifiers that make no solid of ours.
pub(super) const REFUSED: [&str; 4] = ["clipped_by", "matrix", "open", "transform"];

/// Words for truth and numbers.
pub(super) fn truth(word: &str) -> Option<bool> {
    match word {
        "on" | "true" | "yes" => Some(true),
        "off" | "false" | "no" => Some(false),
        _ => None,
    }
}

/// Whether a word begins an object.
pub(super) fn is_object(word: &str) -> bool {
    is_solid(word) || NOT_OURS.contains(&word)
}

/// Whether a word begins a solid that is exact here.
pub(super) fn is_solid(word: &str) -> bool {
    SOLIDS.contains(&word)
}
