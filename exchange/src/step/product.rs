//! The product whose shape the solids are, and the units.

use super::part21::{Exchange, Id, List, Real};
use super::{Protocol, StepOptions};
use premio_kernel::unit::Unit;
use premio_text::escape;

/// The ratio of the accuracy to the uncertainty stated in the file. Readers use the uncertainty for
/// what a file leaves to them, such as the course of circles in the parameters of faces.
const FINER: f64 = 1024.0;

/// The context of the shape: three dimensions, its units, and the distance within which points are
/// equal.
pub(super) fn context(exchange: &mut Exchange, options: &StepOptions) -> Id {
    let length = length_unit(exchange, options.unit);
    let radian = exchange.add(format_args!(
        "(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))"
    ));
    let steradian = exchange.add(format_args!(
        "(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())"
    ));
    let uncertainty = exchange.add(format_args!(
        "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE({}),{length},'distance_accuracy_value','')",
        Real(options.accuracy / FINER)
    ));
    exchange.add(format_args!(
        "(GEOMETRIC_REPRESENTATION_CONTEXT(3)\
         GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({uncertainty}))\
         GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{radian},{steradian}))\
         REPRESENTATION_CONTEXT('',''))"
    ))
}

fn length_unit(exchange: &mut Exchange, unit: Unit) -> Id {
    let prefix = match unit {
        Unit::Metre => "$",
        Unit::Centimetre => ".CENTI.",
        Unit::Millimetre | Unit::Inch => ".MILLI.",
        Unit::Micrometre => ".MICRO.",
    };
    let si = exchange.add(format_args!(
        "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT({prefix},.METRE.))"
    ));
    if unit != Unit::Inch {
        return si;
    }
    let size = exchange.add(format_args!(
        "LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),{si})"
    ));
    let exponents = exchange.add(format_args!("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)"));
    exchange.add(format_args!(
        "(CONVERSION_BASED_UNIT('INCH',{size})LENGTH_UNIT()NAMED_UNIT({exponents}))"
    ))
}

/// The product, with its solids as its shape.
pub(super) fn product(exchange: &mut Exchange, options: &StepOptions, context: Id, solids: &[Id]) {
    let name = escape::step(&options.name);
    let (application, protocol, year) = match options.protocol {
        Protocol::Ap242 => (
            "managed model based 3d engineering",
            "ap242_managed_model_based_3d_engineering",
            2014,
        ),
        Protocol::Ap214 => (
            "core data for automotive mechanical design processes",
            "automotive_design",
            2000,
        ),
    };
    let application = exchange.add(format_args!("APPLICATION_CONTEXT('{application}')"));
    exchange.add(format_args!(
        "APPLICATION_PROTOCOL_DEFINITION('international standard','{protocol}',{year},{application})"
    ));
    let of_product = exchange.add(format_args!(
        "PRODUCT_CONTEXT('',{application},'mechanical')"
    ));
    let product = exchange.add(format_args!("PRODUCT('{name}','{name}','',({of_product}))"));
    exchange.add(format_args!(
        "PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,({product}))"
    ));
    let formation = exchange.add(format_args!(
        "PRODUCT_DEFINITION_FORMATION('','',{product})"
    ));
    let design = exchange.add(format_args!(
        "PRODUCT_DEFINITION_CONTEXT('part definition',{application},'design')"
    ));
    let definition = exchange.add(format_args!(
        "PRODUCT_DEFINITION('design','',{formation},{design})"
    ));
    let of_shape = exchange.add(format_args!("PRODUCT_DEFINITION_SHAPE('','',{definition})"));
    let origin = exchange.add(format_args!("CARTESIAN_POINT('',(0.,0.,0.))"));
    let z = exchange.add(format_args!("DIRECTION('',(0.,0.,1.))"));
    let x = exchange.add(format_args!("DIRECTION('',(1.,0.,0.))"));
    let placement = exchange.add(format_args!("AXIS2_PLACEMENT_3D('',{origin},{z},{x})"));
    let items: Vec<Id> = std::iter::once(placement)
        .chain(solids.iter().copied())
        .collect();
    let representation = exchange.add(format_args!(
        "ADVANCED_BREP_SHAPE_REPRESENTATION('{name}',{},{context})",
        List(&items)
    ));
    exchange.add(format_args!(
        "SHAPE_DEFINITION_REPRESENTATION({of_shape},{representation})"
    ));
}
