//! The section `[target]`: which faces are meant to bind, and the pose of the moving tile when they
//! do.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use super::error::{DesignError, Result};
use super::face::find_face;
use super::quantity::four_digits;
use super::reader::{Entry, Section};
use super::tile::{TILES, TileEntry};
use super::tolerance::{Lengths, allowance, distinguished, micrometres, nearly_equal};
use physics::bisection::bisected;
use physics::configuration::Configuration;
use physics::contact::Contact;
use physics::tile::outline::cross;
use physics::tile::{Face, Tile};

/// The target as the file gives it.
pub(super) struct Target<'a> {
    /// Face of the fixed tile, face of the moving tile.
    pub faces: (usize, usize),
    /// Whether no equal contact counts as the bond.
    pub only: bool,
    /// Largest allowed overlap (m).
    pub allowance: f64,
    /// A warning that they are not quite equal.
    pub doubt: Option<DesignError>,
    /// The names of the two faces.
    names: [String; 2],
    /// The section of the second one.
    faces_of: &'static str,
    moving: Entry<'a>,
}

const HELP: &str =
    "name the two faces that should bind: [target] fixed = \"east\", moving = \"west\"";
const HELP_OF_ONE: &str = "name the two faces that should bind, faces = [\"0\", \"2\"], or the one \
    that binds its own kind: faces = [\"0\"]";

/// The keys of `[target]`.
pub(super) const KEYS: [&str; 4] = ["fixed", "moving", "faces", "only"];

pub(super) fn read<'a>(root: &Section<'a>, tiles: &[TileEntry; 2]) -> Result<Target<'a>> {
    let is_one = tiles[1].name != TILES[1];
    let help = if is_one { HELP_OF_ONE } else { HELP };
    let section = root.require("target", help)?.section("[target]")?;
    section.allow(&KEYS);
    let only = section.get("only").map(|entry| {
        let value = entry.boolean();
        value.ok_or_else(|| entry.error("`only` must be true or false", "write only = true"))
    });
    let entries = entries(&section, help)?;
    let face = |i: usize| find_face(&tiles[i].base.names, &entries[i], tiles[i].name);
    let (fixed, moving) = (face(0)?, face(1)?);
    let entry = entries[1];
    let lengths = [(0, fixed), (1, moving)].map(|(i, face)| tiles[i].base.faces[face].length());
    section.source.faults.check_guesses()?;
    let lengths: [f64; 2] = lengths;
    let [a, b] = lengths;
    let kind = Lengths::of(a, b);
    if kind == Lengths::Unequal {
        let [a, b] = distinguished(a, b);
        return Err(entry.error(
            format!("the target faces cannot coincide: they are {a} and {b} long"),
            "choose two faces of equal length",
        ));
    }
    // A mate that is nearly as long is reported at its `mates`.
    let mates = tiles[1].mates_of(moving).is_some();
    let doubt = (kind == Lengths::Near && !mates)
        .then(|| nearly_equal(&entry, "the target faces measure", a, b));
    Ok(Target {
        faces: (fixed, moving),
        only: only.transpose()?.unwrap_or(false),
        allowance: allowance(a, b),
        names: [(0, fixed), (1, moving)].map(|(i, face)| tiles[i].base.faces[face].name.clone()),
        faces_of: match tiles[1].name {
            "tile" => "[tile.faces]",
            "fixed" => "[fixed.faces]",
            _ => "[moving.faces]",
        },
        moving: entry,
        doubt,
    })
}

/// The entries that name the face of the fixed and of the moving tile: `fixed` and `moving`, or the
/// list `faces`.
fn entries<'a>(section: &Section<'a>, help: &str) -> Result<[Entry<'a>; 2]> {
    let Some(listed) = section.get("faces") else {
        let [fixed, moving] = TILES.map(|key| section.require(key, help));
        return Ok([fixed?, moving?]);
    };
    if let Some(other) = TILES.iter().find_map(|key| section.get(key)) {
        let message = format!("`faces` and `{}` both name target faces", other.key);
        return Err(other.key_error(message, "keep one of the two"));
    }
    match listed.array()?[..] {
        [own] => Ok([own, own]),
        [fixed, moving] => Ok([fixed, moving]),
        _ => Err(listed.error("`faces` must name one or two faces", help)),
    }
}

/// The contact of two tiles with their target faces.
pub(super) enum Bound {
    /// The bound configuration; with a warning if they had to be drawn apart to touch.
    At(Configuration, Option<DesignError>),
    /// They overlap by this much (m), within the allowance, and drawing them apart does not help.
    Overlap(f64),
}

/// Number of bisections of the distance by which tiles are drawn apart: to 1e-13 of the allowance.
const HALVINGS: u32 = 44;

impl Target<'_> {
    /// The configuration in which the two base lines coincide, face to face; the tiles are drawn
    /// apart if they overlap by less than a cutter resolves.
    pub fn meet(&self, fixed: &Tile, moving: &Tile) -> Result<Bound> {
        let flush = face_to_face(&fixed.faces[self.faces.0], &moving.faces[self.faces.1]);
        let contact = Contact::new(&fixed.outline, &moving.outline);
        let depth = |q: &Configuration| -contact.clearance(q);
        let overlap = depth(&flush);
        if overlap <= contact.touch() {
            return Ok(Bound::At(flush, None));
        }
        if overlap > self.allowance {
            return self.meet_in_a_point((fixed, moving), &contact, flush, overlap);
        }
        let out = fixed.faces[self.faces.0].normal();
        let drawn = |by: f64| {
            let place = flush.position() + out * by;
            Configuration::new(clean(place.x), clean(place.y), flush.theta)
        };
        let overlaps = |by: f64| depth(&drawn(by)) > contact.touch();
        if overlaps(self.allowance) {
            return Ok(Bound::Overlap(overlap));
        }
        let [_, outside] = bisected(0.0, self.allowance, HALVINGS, overlaps);
        let doubt = self.overlapping(
            overlap,
            &format!(
                "the outlines stay as drawn; the bond is where they touch, {} farther apart",
                micrometres(outside)
            ),
        );
        Ok(Bound::At(drawn(outside), Some(doubt)))
    }

    /// The contact of two faces that bulge, which touch in a point instead of coinciding. Other faces
    /// cannot meet.
    fn meet_in_a_point(
        &self,
        (fixed, moving): (&Tile, &Tile),
        contact: &Contact,
        flush: Configuration,
        overlap: f64,
    ) -> Result<Bound> {
        let faces = [
            (fixed, &fixed.faces[self.faces.0]),
            (moving, &moving.faces[self.faces.1]),
        ];
        if !faces.iter().all(|(tile, face)| bulges(tile, face)) {
            return Err(self.blocked(overlap));
        }
        let out = faces[0].1.normal();
        let Some(apart) = contact.landing(&flush, out).filter(|apart| *apart > 0.0) else {
            return Err(self.blocked(overlap));
        };
        let place = flush.position() + out * apart;
        let met = Configuration::new(clean(place.x), clean(place.y), flush.theta);
        if !contact.is_free(&met) {
            return Err(self.blocked(overlap));
        }
        let doubt = self.moving.source.doubt(
            self.moving.span(),
            "the target faces bulge towards each other, so they touch in a point instead of coinciding",
            format!(
                "the bond is where they touch, {} mm farther apart than the ends of the faces; for faces \
                 that coincide {}",
                four_digits(apart * 1e3),
                self.complement()
            ),
        );
        Ok(Bound::At(met, Some(doubt)))
    }

    /// The error that the target faces cannot meet because of an overlap (m).
    pub fn blocked(&self, overlap: f64) -> DesignError {
        self.moving.error(
            format!(
                "the target faces cannot coincide: there the tiles overlap by {} mm",
                four_digits(overlap * 1e3)
            ),
            self.complement(),
        )
    }

    /// How the target faces become complements.
    fn complement(&self) -> String {
        let ([one, other], faces_of) = (&self.names, self.faces_of);
        match one == other && faces_of != "[moving.faces]" {
            // A face that mates itself has no shape.
            true => format!(
                "make {one} its own complement, straight or with h(-s) = -h(s) as teeth have, or name a \
                 second face, faces = [\"{one}\", \"FACE\"], with FACE = {{ mates = \"{one}\" }} under \
                 {faces_of}"
            ),
            false => format!(
                "make the second face the complement of the first: {other} = {{ mates = \"{one}\" }} under \
                 {faces_of}"
            ),
        }
    }

    /// The warning that the target faces overlap by this much (m), and how that is treated.
    pub fn overlapping(&self, overlap: f64, made: &str) -> DesignError {
        self.moving.source.doubt(
            self.moving.span(),
            format!(
                "the target faces overlap by {} where they coincide, less than a cutter can \
                 resolve",
                micrometres(overlap)
            ),
            made,
        )
    }
}

/// Bulges below this share of a face are rounding.
const STRAIGHT: f64 = 1e-9;

/// The steepest slope of a bulge that rises from straight ends of its face; a tab is steeper.
const GENTLE: f64 = 1.0;

/// Whether the outline over a face lies outside its base line without any corner that cuts in, but
/// for straight ends from which it rises gently.
fn bulges(tile: &Tile, face: &Face) -> bool {
    let rounding = STRAIGHT * face.length();
    let local = |p: &Vector2<f64>| {
        let from = p - face.middle();
        [from.dot(&face.tangent()), from.dot(&face.normal())]
    };
    let corners = tile.outline.vertices();
    let nearest = |end: f64| {
        let end = face.point(end * face.length() / 2.0, 0.0);
        let distance = |k: &usize| OrderedFloat((corners[*k] - end).norm());
        (0..corners.len()).min_by_key(distance).unwrap_or(0)
    };
    let [first, last] = [nearest(-1.0), nearest(1.0)];
    let count = (last + corners.len() - first) % corners.len();
    let along = (0..=count).map(|k| local(&corners[(first + k) % corners.len()]));
    let mut line: Vec<[f64; 2]> = along.collect();
    if line.iter().any(|[_, h]| *h < -rounding) {
        return false;
    }
    let is_gentle = line.windows(2).all(|two| {
        let [[a, b], [c, d]] = [two[0], two[1]];
        (d - b).abs() <= GENTLE * (c - a)
    });
    let rises = |[_, h]: &[f64; 2]| *h > rounding;
    if let Some(first) = line.iter().position(rises).filter(|_| is_gentle) {
        let last = line.iter().rposition(rises).unwrap_or(first);
        line = line[first.saturating_sub(1)..line.len().min(last + 2)].to_vec();
    }
    // The direction turns one way only: clockwise, along increasing s.
    line.windows(3).all(|three| {
        let [[a, b], [c, d], [e, f]] = [three[0], three[1], three[2]];
        (c - a) * (f - d) - (e - c) * (d - b) <= rounding * face.length()
    })
}

/// The pose of the moving tile when its face lies on the fixed tile's, in opposite direction.
fn face_to_face(fixed: &Face, moving: &Face) -> Configuration {
    let (to, from) = (-fixed.normal(), moving.normal());
    let theta = libm::atan2(clean(cross(from, to)), clean(from.dot(&to)));
    let turned = Configuration::new(0.0, 0.0, theta).transform(moving.middle());
    let position: Vector2<f64> = fixed.middle() - turned;
    Configuration::new(clean(position.x), clean(position.y), theta)
}

/// Replaces rounding errors by exact zero, so that squares meet at exact right angles; never
/// returns -0.
fn clean(x: f64) -> f64 {
    if x.abs() < 1e-15 { 0.0 } else { x }
}
