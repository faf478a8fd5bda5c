//! The scale of a drawing.

use std::str::FromStr;

use kurbo::Affine;
use roxmltree::Node;
use svgtypes::{Align, AspectRatio, Length, LengthUnit, ViewBox};

use super::super::error::{Result, Span};
use super::super::source::Source;
use super::path::{INCH, metres};

/// Largest relative difference of the scales along x and y, or of two statements of the same scale.
const SAME_SCALE: f64 = 1e-4;

/// The units that a design can state for a drawing.
pub(in crate::design) const UNITS: [(&str, f64); 6] = [
    ("mm", 1e-3),
    ("cm", 1e-2),
    ("m", 1.0),
    ("in", INCH),
    ("pt", INCH / 72.0),
    ("px", INCH / 96.0),
];

/// The transform from user units, y down, to metres, y up; `None` if neither the drawing nor the
/// design states the length of a user unit.
pub(super) fn scale(source: Source, root: Node, unit: Option<f64>) -> Result<Option<Affine>> {
    let size = view_box(source, root)?.map(|view_box| [view_box.w, view_box.h]);
    let stated = stated_scale(source, root, size)?;
    let [x, y] = match (unit, stated) {
        (Some(unit), Some(stated)) if !agree(unit, stated[0]) || !agree(unit, stated[1]) => {
            let message = format!(
                "a user unit is {} mm in the drawing but {} mm in the design",
                1e3 * stated[0],
                1e3 * unit
            );
            let help = "remove `unit` or `dpi`: the drawing has its own size";
            return Err(source.error(span(root), message, help));
        }
        (_, Some(stated)) => stated,
        (Some(unit), None) => [unit, unit],
        (None, None) => return Ok(None),
    };
    Ok(Some(Affine::scale_non_uniform(x, -y)))
}

/// The `viewBox` of an element.
pub(super) fn view_box(source: Source, node: Node) -> Result<Option<ViewBox>> {
    let attribute = node.attribute_node("viewBox");
    let read = attribute.map(|attribute| {
        ViewBox::from_str(attribute.value()).map_err(|error| {
            let help = "give four numbers: viewBox=\"0 0 430 430\"";
            source.error(attribute.range_value().into(), error.to_string(), help)
        })
    });
    read.transpose()
}

/// The transform from an element's view box to its viewport, according to its
/// `preserveAspectRatio`.
pub(super) fn fitted(node: Node, view_box: ViewBox, [x, y, w, h]: [f64; 4]) -> Affine {
    let aspect = aspect(node).unwrap_or_default();
    let (sx, sy) = (w / view_box.w, h / view_box.h);
    let (sx, sy) = match (aspect.align, aspect.slice) {
        (Align::None, _) => (sx, sy),
        (_, false) => (sx.min(sy), sx.min(sy)),
        (_, true) => (sx.max(sy), sx.max(sy)),
    };
    let (left, top) = match aspect.align {
        Align::None | Align::XMinYMin => (0.0, 0.0),
        Align::XMidYMin => (0.5, 0.0),
        Align::XMaxYMin => (1.0, 0.0),
        Align::XMinYMid => (0.0, 0.5),
        Align::XMidYMid => (0.5, 0.5),
        Align::XMaxYMid => (1.0, 0.5),
        Align::XMinYMax => (0.0, 1.0),
        Align::XMidYMax => (0.5, 1.0),
        Align::XMaxYMax => (1.0, 1.0),
    };
    let room = (w - sx * view_box.w, h - sy * view_box.h);
    Affine::translate((x + left * room.0, y + top * room.1))
        * Affine::scale_non_uniform(sx, sy)
        * Affine::translate((-view_box.x, -view_box.y))
}

fn aspect(node: Node) -> Option<AspectRatio> {
    AspectRatio::from_str(node.attribute("preserveAspectRatio")?).ok()
}

/// The length (m) of a user unit along x and y, if the drawing states it.
fn stated_scale(
    source: Source,
    root: Node,
    view_box: Option<[f64; 2]>,
) -> Result<Option<[f64; 2]>> {
    let mut stated = [None, None];
    for (k, name) in ["width", "height"].into_iter().enumerate() {
        let length = root.attribute(name).map(Length::from_str);
        let Some(Ok(Length { number, unit })) = length else {
            continue;
        };
        let Some(metres) = metres(unit) else {
            continue;
        };
        if number <= 0.0 || !number.is_finite() {
            let help = "give the drawing a width and a height";
            return Err(source.error(span(root), format!("a {name} of {number}"), help));
        }
        // Without a view box, user units are CSS px.
        let user_units = view_box.map_or(number * metres / (INCH / 96.0), |size| size[k]);
        stated[k] = Some(number * metres / user_units);
    }
    let px = |name| {
        let length = root.attribute(name).map(Length::from_str);
        matches!(length, Some(Ok(length)) if matches!(length.unit, LengthUnit::None | LengthUnit::Px))
    };
    let scales = match stated {
        [Some(x), Some(y)] => [x, y],
        [Some(one), None] if !px("height") => [one, one],
        [None, Some(one)] if !px("width") => [one, one],
        _ => return Ok(None),
    };
    if agree(scales[0], scales[1]) {
        // As in viewers, the whole drawing fits.
        let fit = scales[0].min(scales[1]);
        return Ok(Some([fit, fit]));
    }
    match aspect(root) {
        Some(aspect) if aspect.align == Align::None => return Ok(Some(scales)),
        Some(aspect) if aspect.slice => return Ok(Some([scales[0].max(scales[1]); 2])),
        Some(_) => return Ok(Some([scales[0].min(scales[1]); 2])),
        None => {}
    }
    let message = format!(
        "width and height do not match the view box: a user unit is {} mm along x, {} mm along y",
        1e3 * scales[0],
        1e3 * scales[1]
    );
    let help = "give the drawing a size with the proportions of its view box";
    Err(source.error(span(root), message, help))
}

/// The name in an element's tag.
pub(super) fn span(node: Node) -> Span {
    let start = node.range().start + 1;
    let tag = &node.document().input_text()[start..];
    let ends = |c: char| c.is_whitespace() || matches!(c, '/' | '>');
    (start..start + tag.find(ends).unwrap_or(0)).into()
}

fn agree(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME_SCALE * a.max(b)
}
