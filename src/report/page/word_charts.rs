//! The charts of a set of words: how wide the gaps are, and number against gap.

use std::fmt::Write;

use physics::words::Answer;

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

/// How many pairs have which gap.
pub(super) fn histogram(gaps: &[f64]) -> String {
    const BINS: usize = 40;
    let [left, top, width, height] = AREA;
    let mut counts = [0usize; BINS];
    for gap in gaps {
        let gap = gap.clamp(0.0, 1.0);
        counts[((gap * BINS as f64) as usize).min(BINS - 1)] += 1;
    }
    let most = counts.iter().copied().max().unwrap_or(1).max(1);
    let step = width / BINS as f64;
    let mut inner = String::new();
    for (k, count) in counts.iter().enumerate() {
        let tall = height * *count as f64 / most as f64;
        let _ = write!(
            inner,
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{tall:.1}\" \
             fill=\"#0072b2\"><title>{count}</title></rect>",
            left + step * k as f64,
            top + height - tall,
            step - 1.0
        );
    }
    for k in 0..=4 {
        let share = f64::from(k) / 4.0;
        inner += &label(
            left + width * share,
            top + height + 18.0,
            "middle",
            &share.to_string(),
        );
    }
    inner += &label(left - 6.0, top + 10.0, "end", &most.to_string());
    chart("gap of the pair", "pairs", &inner)
}

/// Proved points are filled, others open with a line up to their bound.
pub(super) fn frontier(answer: &Answer) -> String {
    let [left, top, width, height] = AREA;
    let counts = answer
        .frontier
        .iter()
        .map(|it| it.0.found.upper.min(1 << 20));
    let most = counts.max().unwrap_or(1).max(2) as f64;
    let x = |gap: f64| left + width * gap;
    // From none on, then by factors.
    let y = |count: usize| {
        let level = libm::log(1.0 + (count as f64).min(most)) / libm::log(1.0 + most);
        top + height * (1.0 - level)
    };
    let mut inner = String::new();
    for (point, _) in &answer.frontier {
        let (count, upper) = (point.found.words.len(), point.found.upper);
        let at = x(point.asked);
        if !point.found.is_proved() {
            let (high, low) = (y(upper), y(count));
            let _ = write!(
                inner,
                "<path d=\"M{at:.1},{high:.1}V{low:.1}M{:.1},{high:.1}h10\" stroke=\"#d55e00\" \
                 fill=\"none\"/>",
                at - 5.0
            );
        }
        let fill = if point.found.is_proved() {
            "#0072b2"
        } else {
            "#fff"
        };
        let stroke = if point.found.is_proved() {
            "#0072b2"
        } else {
            "#d55e00"
        };
        let _ = write!(
            inner,
            "<circle cx=\"{at:.1}\" cy=\"{:.1}\" r=\"5\" fill=\"{fill}\" stroke=\"{stroke}\" \
             stroke-width=\"2\"><title>{count} to {upper}</title></circle>",
            y(count)
        );
        inner += &label(at + 8.0, y(count) - 6.0, "start", &count.to_string());
    }
    for k in 0..=4 {
        let gap = f64::from(k) / 4.0;
        inner += &label(x(gap), top + height + 18.0, "middle", &gap.to_string());
    }
    let mut tick = 1usize;
    while (tick as f64) <= most {
        inner += &label(left - 6.0, y(tick) + 4.0, "end", &tick.to_string());
        tick *= 10;
    }
    inner += &label(
        left + width,
        top + 4.0,
        "end",
        "filled: proved; open: found, line: at most",
    );
    chart("gap asked for", "words", &inner)
}
