//! What small charts have in common.

const OPEN: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" font-family=\"Noto Sans, Helvetica, \
                    Arial, sans-serif\"";

/// The plot area of the small charts (pixels): left, top, width, height.
pub(super) const AREA: [f64; 4] = [64.0, 20.0, 560.0, 260.0];

pub(super) fn chart(x_name: &str, y_name: &str, inner: &str) -> String {
    let [left, top, width, height] = AREA;
    let (w, h) = (left + width + 20.0, top + height + 56.0);
    format!(
        "{OPEN} viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\"><rect width=\"100%\" \
         height=\"100%\" fill=\"#fff\"/>{inner}<path d=\"M{left},{top}V{bottom}H{right}\" \
         fill=\"none\" stroke=\"#222\"/><text x=\"{middle}\" y=\"{below}\" font-size=\"14\" \
         text-anchor=\"middle\" fill=\"#222\">{x_name}</text><text x=\"16\" y=\"{half}\" \
         font-size=\"14\" text-anchor=\"middle\" fill=\"#222\" \
         transform=\"rotate(-90 16 {half})\">{y_name}</text></svg>",
        bottom = top + height,
        right = left + width,
        middle = left + width / 2.0,
        below = top + height + 44.0,
        half = top + height / 2.0
    )
}

pub(super) fn label(x: f64, y: f64, anchor: &str, text: &str) -> String {
    format!(
        "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"12\" text-anchor=\"{anchor}\" \
         fill=\"#222\">{text}</text>"
    )
}
