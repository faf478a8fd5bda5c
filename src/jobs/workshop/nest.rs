//! Parts on sheets of material: rectangles in rows. Not optimal, but nothing overlaps.

/// The place of a rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetPlace {
    /// The sheet, from 0.
    pub sheet: usize,
    /// The lower left corner on it (m).
    pub corner: [f64; 2],
    /// Whether the rectangle is turned by a quarter turn.
    pub turned: bool,
}

/// A row of a sheet.
struct Row {
    sheet: usize,
    low: f64,
    high: f64,
    used: f64,
}

/// Places rectangles (m) on sheets (m), `apart` (m) from each other and from the edges; `None` if
/// one is larger than a sheet.
///
/// Highest first, each in the first row with room; where rectangles may be turned, lying down if it
/// fits.
pub fn nest(
    sizes: &[[f64; 2]],
    sheet: [f64; 2],
    apart: f64,
    may_turn: bool,
) -> Option<Vec<SheetPlace>> {
    let room = sheet.map(|length| length - apart);
    let fits = |[w, h]: [f64; 2]| w + apart <= room[0] + 1e-9 && h + apart <= room[1] + 1e-9;
    let laid: Option<Vec<(bool, [f64; 2])>> = sizes
        .iter()
        .map(|&[w, h]| {
            let ways = if w >= h || !may_turn {
                [(false, [w, h]), (true, [h, w])]
            } else {
                [(true, [h, w]), (false, [w, h])]
            };
            let mut allowed = ways.into_iter().filter(|way| may_turn || !way.0);
            allowed.find(|way| fits(way.1))
        })
        .collect();
    let laid = laid?;
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by(|&a, &b| laid[b].1[1].total_cmp(&laid[a].1[1]).then(a.cmp(&b)));
    let mut rows: Vec<Row> = Vec::new();
    let mut places = vec![None; sizes.len()];
    for part in order {
        let (turned, [w, h]) = laid[part];
        let has_room = |row: &&mut Row| {
            row.used + w + apart <= room[0] + 1e-9 && h <= row.high - row.low + 1e-12
        };
        let row = match rows.iter_mut().find(has_room) {
            Some(row) => row,
            None => {
                let top = rows
                    .last()
                    .map_or((0, apart), |row| (row.sheet, row.high + apart));
                let (sheet, low) = match top.1 + h <= room[1] + 1e-9 {
                    true => top,
                    false => (top.0 + 1, apart),
                };
                rows.push(Row {
                    sheet,
                    low,
                    high: low + h,
                    used: 0.0,
                });
                rows.last_mut()?
            }
        };
        places[part] = Some(SheetPlace {
            sheet: row.sheet,
            corner: [row.used + apart, row.low],
            turned,
        });
        row.used += w + apart;
    }
    places.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rectangles of all proportions: apart from each other and from the edges by what is required.
    #[test]
    fn parts_on_a_sheet_are_apart() {
        let mut state = 7_u64;
        let mut random = |low: f64, high: f64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..200 {
            let count = random(1.0, 40.0) as usize;
            let sizes: Vec<[f64; 2]> = (0..count)
                .map(|_| [random(0.005, 0.39), random(0.005, 0.39)])
                .collect();
            let (sheet, apart) = ([0.6, 0.4], random(0.0, 0.005));
            let places = nest(&sizes, sheet, apart, true).unwrap();
            let boxes: Vec<(usize, [f64; 4])> = places
                .iter()
                .zip(&sizes)
                .map(|(place, &[w, h])| {
                    let [w, h] = if place.turned { [h, w] } else { [w, h] };
                    let [x, y] = place.corner;
                    (place.sheet, [x, y, x + w, y + h])
                })
                .collect();
            let gap = apart - 1e-9;
            for (i, (sheet_a, a)) in boxes.iter().enumerate() {
                assert!(a[0] >= gap && a[1] >= gap);
                assert!(a[2] <= sheet[0] - gap && a[3] <= sheet[1] - gap);
                for (sheet_b, b) in &boxes[..i] {
                    let clear = (0..2).any(|k| a[k] - b[k + 2] >= gap || b[k] - a[k + 2] >= gap);
                    assert!(sheet_a != sheet_b || clear, "{a:?} {b:?}");
                }
            }
        }
        assert_eq!(nest(&[[0.61, 0.1]], [0.6, 0.4], 0.0, true), None);
        assert!(nest(&[[0.1, 0.6]], [0.6, 0.4], 0.0, true).is_some_and(|it| it[0].turned));
        assert_eq!(nest(&[[0.1, 0.6]], [0.6, 0.4], 0.0, false), None);
    }
}
