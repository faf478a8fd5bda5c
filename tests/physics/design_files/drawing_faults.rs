//! Drawings that are refused, and where.

use super::drawings::{design, drawn, outlined, parse, profiled};

/// Each drawing with its message, and the line and column of the fault.
#[test]
fn drawings_are_refused_where_the_fault_is() {
    let cases: [(&str, &str, &str); 20] = [
        (
            "<path d=\"M0 0h100v100h-100\"/>",
            "the outline is open: its ends are 100 mm apart",
            "2:2",
        ),
        (
            "<path d=\"M0 0h100v100h-50v-150h-50z\"/>",
            "crosses or touches itself",
            "2:2",
        ),
        ("\n<path\n d=\"M0 0h100q\"/>", "`d` cannot be read", "4:13"),
        (
            "<path d=\"M0 0h9v9z M20 20h9v9z\"/>",
            "draws 2 lines, not one",
            "2:2",
        ),
        (
            "<polygon points=\"0,0 9,9 x,1\"/>",
            "`points` cannot be read",
            "2:26",
        ),
        ("<rect height=\"9\"/>", "a rectangle without a width", "2:2"),
        ("<circle r=\"10em\"/>", "relative to something else", "2:12"),
        (
            "<g transform=\"turn(9)\"><path d=\"M0 0h9v9z\"/></g>",
            "`transform` cannot be read",
            "2:15",
        ),
        (
            "<path style=\"transform:scale(2)\" d=\"M0 0h9v9z\"/>",
            "transforms in styles",
            "2:2",
        ),
        (
            "<path d=\"M0 0h9v9z\"/>\n<circle id=\"b\" r=\"9\"/>",
            "has 2 shapes",
            "3:2",
        ),
        (
            "<text>a</text><use href=\"#b\"/>",
            "the drawing has no shape that can be read, but <text> in line 2, <use> of \"#b\", which \
             is not in the drawing in line 2",
            "2:2",
        ),
        ("", "the drawing has no shape", "1:1"),
        (
            "<g id=\"a\"><use href=\"#b\"/></g><g id=\"b\"><use href=\"#a\"/></g>",
            "refers to itself",
            "2:42",
        ),
        (
            "<line x2=\"100\"/><line x1=\"100\" x2=\"100\" y2=\"100\"/>\n<path d=\"M100 100L0 .5\"/>",
            "the outline is open: its ends are 0.5 mm apart",
            "2:2",
        ),
        (
            "<path transform=\"scale(1e200)\" d=\"M0 0h1e200v9z\"/>",
            "not finite",
            "2:2",
        ),
        (
            "<path d=\"M0 0h100v100C1e15 0 0 100 0 100z\"/>",
            "from the drawing's origin",
            "2:2",
        ),
        ("<path d=\"M0 0h9v9z\">", "not well-formed XML", "3:1"),
        (
            "<path d=\"M0 0h.1v.1z\"/>",
            "the outline's width = 0.0001 m is too small",
            "2:2",
        ),
        (
            "<path transform=\"scale(0)\" d=\"M0 0h9v9z\"/>",
            "the outline's width must be above zero, not 0 m",
            "2:2",
        ),
        (
            "<path d=\"M0 0L1e400 0v9z\"/>",
            "`d` cannot be read",
            "2:15",
        ),
    ];
    for (content, expected, at) in cases {
        let error = outlined(&drawn(content), "").unwrap_err();
        assert!(error.file.ends_with("a.svg"), "{error}");
        assert!(error.message.contains(expected), "{error}");
        let place = error.place.as_ref().unwrap();
        assert_eq!(format!("{}:{}", place.line, place.column), at, "{error}");
    }
    let square = "<rect width=\"100\" height=\"100\"/>";
    for (head, keys, expected) in [
        ("", "", "does not give its size"),
        (
            "width=\"400px\" height=\"400px\"",
            "",
            "does not give its size",
        ),
        (
            "width=\"40mm\" height=\"40px\" viewBox=\"0 0 4 4\"",
            "",
            "does not give its size",
        ),
        (
            "width=\"100%\" viewBox=\"0 0 4 4\"",
            "",
            "does not give its size",
        ),
        (
            "width=\"40mm\" height=\"50mm\" viewBox=\"0 0 4 4\"",
            "",
            "do not match the view box",
        ),
        (
            "width=\"40mm\" viewBox=\"0 0 40 40\"",
            ", unit = \"cm\"",
            "user unit is 1 mm in the drawing but 10",
        ),
        ("width=\"40mm\" viewBox=\"0 0 4\"", "", "viewBox"),
        (
            "transform=\"scale(2)\" width=\"40mm\"",
            "",
            "of the whole drawing",
        ),
    ] {
        let drawing = format!("<svg {head}>{square}</svg>");
        let error = outlined(&drawing, keys).unwrap_err();
        assert!(error.message.contains(expected), "{error}");
        assert_eq!(error.place.as_ref().unwrap().line, 1);
    }
    for (content, expected) in [
        ("<path d=\"M0 0h100v10h100\"/>", "one is 10 mm higher"),
        ("<path d=\"M0 0h100v-10h-100z\"/>", ""),
        ("<path d=\"M0 0v-10h10v10h-10\"/>", ""),
        ("<circle r=\"50\"/>", "must have one edge on the base line"),
        ("<path d=\"M0 0v10\"/>", "the line's width"),
        (
            "<path d=\"M0 0L60-40L40-40L100 0\"/>",
            "crosses or touches itself",
        ),
        ("<path d=\"M0 0L-20-20L-20 20L100 0\"/>", "beyond its ends"),
    ] {
        match profiled(&drawn(content), "") {
            Ok(_) => assert_eq!(expected, "", "{content}"),
            Err(error) => {
                assert!(
                    !expected.is_empty() && error.message.contains(expected),
                    "{error}"
                );
            }
        }
    }
}

#[test]
fn a_fault_in_the_design_is_told_there() {
    let square = drawn("<rect id=\"plate\" width=\"100\" height=\"100\"/>");
    for (keys, expected) in [
        (", id = \"plat\"", "did you mean `plate`?"),
        (", unit = \"inch\"", "known: mm, cm, m, in, pt, px"),
        (", corner = []", "did you mean `corners`?"),
        (", corners = [[0.05, 0.05]]", "two corners or more"),
    ] {
        let error = outlined(&square, keys).unwrap_err();
        assert!(error.file.ends_with("design.toml"));
        assert!(error.help.contains(expected), "{error}");
    }
    let nameless = drawn("<rect width=\"100\" height=\"100\"/>");
    let error = outlined(&nameless, ", id = \"plate\"").unwrap_err();
    assert!(error.help.starts_with("remove `id`"), "{error}");
    let text = design("outline = { file = \"b.svg\" }", "", "side = 0.1", (0, 0));
    let error = parse(&square, &text).unwrap_err();
    assert!(
        error.message.contains("cannot read the drawing \"b.svg\""),
        "{error}"
    );
    let text = design(
        "side = 0.1\noutline = { file = \"a.svg\" }",
        "",
        "side = 0.1",
        (0, 0),
    );
    let error = parse(&square, &text).unwrap_err();
    assert!(
        error.message.contains("both describe the outline"),
        "{error}"
    );
}
