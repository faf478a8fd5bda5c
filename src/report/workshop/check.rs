//! Pages to print at full size, on which glued tiles are laid.

use super::plan::Plan;
use jobs::workshop::Made;
use jobs::workshop::nest::nest;

/// A page of A4 (m).
pub(super) const PAPER: [f64; 2] = [0.210, 0.297];
/// The edge of a page that printers leave white (m).
const WHITE: f64 = 0.012;
/// Room at the lower end of a page for the bar that shows its scale (m), and the bar's length.
const FOOT: f64 = 0.012;
const BAR: f64 = 0.1;
/// Distance of drawings (m), and height of text.
const GAP: f64 = 0.008;
const TEXT: f64 = 0.004;
/// By how much the parts of a tile that is larger than a page overlap (m).
const OVERLAP: f64 = 0.01;

/// The room on a page (m).
fn room() -> [f64; 2] {
    [PAPER[0] - 2.0 * WHITE, PAPER[1] - 2.0 * WHITE - FOOT]
}

/// The pages with each kind of tile, as SVG.
pub(super) fn pages(made: &Made) -> Vec<String> {
    let drawn = made
        .tiles
        .iter()
        .map(|tile| (&tile.name[..], Plan::check(&tile.part)));
    let mut pages = Vec::new();
    let (mut small, mut large) = (Vec::new(), Vec::new());
    for (name, plan) in drawn {
        let [low, high] = plan.extent();
        // With its name below.
        let size = [high[0] - low[0], high[1] - low[1] + 2.0 * TEXT];
        match nest(&[size], room(), 0.0, false) {
            Some(_) => small.push((name, plan, size)),
            None => large.push((name, plan, size)),
        }
    }
    let sizes: Vec<[f64; 2]> = small.iter().map(|it| it.2).collect();
    // The gap to the edges of the room is not needed.
    let wide = room().map(|length| length + 2.0 * GAP);
    for ((name, plan, size), place) in small
        .into_iter()
        .zip(nest(&sizes, wide, GAP, false).unwrap_or_default())
    {
        pages.resize_with(pages.len().max(place.sheet + 1), Plan::default);
        let corner = [
            place.corner[0] - GAP + WHITE,
            place.corner[1] - GAP + WHITE + FOOT,
        ];
        let page: &mut Plan = &mut pages[place.sheet];
        page.append(plan.placed([corner[0], corner[1] + 2.0 * TEXT], false));
        page.text(name, [corner[0] + size[0] / 2.0, corner[1] + TEXT], TEXT);
    }
    let frame = Some([[0.0; 2], PAPER]);
    let small = pages.into_iter().map(|mut page| {
        foot(&mut page, [0.0; 2], "");
        page.svg(frame)
    });
    small
        .chain(
            large
                .into_iter()
                .flat_map(|(name, plan, size)| tiled(name, &plan, size)),
        )
        .collect()
}

/// A tile that is larger than a page, on several that overlap.
fn tiled(name: &str, plan: &Plan, size: [f64; 2]) -> Vec<String> {
    let room = room();
    let step = room.map(|length| length - OVERLAP);
    let count = [0, 1].map(|k| ((size[k] - OVERLAP) / step[k]).ceil().max(1.0) as usize);
    let plan = plan.clone().placed([0.0, 0.0], false);
    let mut pages = Vec::new();
    for row in 0..count[1] {
        for column in 0..count[0] {
            // The lower left corner of this page in the drawing.
            let low = [
                step[0] * column as f64 - WHITE,
                step[1] * row as f64 - WHITE - FOOT,
            ];
            let mut page = plan.clone();
            let text = format!(
                "{name}, page {} of {} in row {} of {} from below; rows and pages overlap by {} mm",
                column + 1,
                count[0],
                row + 1,
                count[1],
                1e3 * OVERLAP
            );
            foot(&mut page, low, &text);
            let high = [low[0] + PAPER[0], low[1] + PAPER[1]];
            pages.push(page.svg(Some([low, high])));
        }
    }
    pages
}

/// The bar that shows the scale, and a line of text, at the lower end of a page whose corner is here.
fn foot(page: &mut Plan, corner: [f64; 2], text: &str) {
    let at = |x: f64, y: f64| [corner[0] + WHITE + x, corner[1] + WHITE / 2.0 + y];
    page.bar(at(0.0, 0.0), BAR);
    page.text("100 mm", at(BAR + 3.0 * TEXT, 0.0), TEXT);
    if !text.is_empty() {
        page.text(text, at(room()[0] / 2.0, 1.5 * TEXT), 0.75 * TEXT);
    }
}
