//! The entries of `[fixed.faces]` and `[moving.faces]`: a face's profile and its magnets.

use super::error::{Result, Span};
use super::magnet::{ListedMagnet, MAGNET_KEYS, MagnetKeys};
use super::profile::read_profile;
use super::quantity;
use super::reader::{Entry, Section, all, nearest_help};
use super::shield::ShieldKeys;
use physics::tile::barcode::{Barcode, BarcodeError};
use physics::tile::profile::{Arcs, Polyline, Profile, complement, complement_arcs};

/// The magnets of a face, before their sizes and spacing are known.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Pattern {
    /// A code, with the place of each of its characters in the file.
    Code(Barcode, Vec<Span>),
    /// Magnets one by one.
    List(Vec<ListedMagnet>),
}

impl Pattern {
    /// The magnets of the mating face, requested at `span`.
    fn mate(&self, span: Span) -> Self {
        match self {
            Self::Code(code, _) => Self::Code(code.mate(), vec![span; code.len()]),
            Self::List(magnets) => {
                let mates = magnets.iter().rev().map(|magnet| magnet.mate(span));
                Self::List(mates.collect())
            }
        }
    }
}

/// The contents of a face, before it is placed on its tile.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FaceContent {
    pub polyline: Polyline,
    /// The points that lie on arcs.
    pub arcs: Arcs,
    /// The profile that the face's own keys describe.
    pub profile: Option<Profile>,
    /// The distance by which the line is drawn back (m).
    pub fit: f64,
    pub pattern: Pattern,
    pub keys: MagnetKeys,
    /// The places in the file of the line, its fit and the magnets.
    pub line_span: Span,
    pub fit_span: Span,
    pub pattern_span: Span,
}

impl FaceContent {
    /// The complement: the line mirrored, every magnet exchanged for the one that binds it.
    fn mate(&self, at: Span) -> Self {
        Self {
            polyline: complement(&self.polyline),
            arcs: complement_arcs(&self.arcs, self.polyline.len()),
            profile: None,
            fit: 0.0,
            pattern: self.pattern.mate(at),
            keys: self.keys.mate(),
            line_span: at,
            fit_span: at,
            pattern_span: at,
        }
    }
}

/// Rejects a face with both a `code` and `magnets`.
pub(super) fn not_placed_twice(face: &Section) -> Result<()> {
    if let (Some(_), Some(magnets)) = (face.get("code"), face.get("magnets")) {
        return Err(magnets.key_error(
            "`code` and `magnets` both place the magnets of this face",
            "keep one of the two",
        ));
    }
    Ok(())
}

/// The entries of one face: its own over `all`.
#[derive(Clone, Copy)]
pub(super) struct FaceEntry<'a> {
    own: Option<Section<'a>>,
    all: Option<Section<'a>>,
}

pub(super) const FACE_KEYS: [&str; 7] = [
    "code", "magnets", "profile", "magnet", "mates", "fit", "shield",
];

impl<'a> FaceEntry<'a> {
    pub fn new(own: Option<Section<'a>>, all: Option<Section<'a>>) -> Result<Self> {
        for section in [&own, &all].into_iter().flatten() {
            section.allow(&FACE_KEYS);
            if let (Some(mates), Some(other)) = (section.get("mates"), first_of(section)) {
                return Err(other.key_error(
                    format!("`mates` and `{}` both describe this face", other.key),
                    format!(
                        "a mate takes its shape and magnets from `{}`: keep one of the two",
                        mates.string()?
                    ),
                ));
            }
            not_placed_twice(section)?;
        }
        Ok(Self { own, all })
    }

    /// The face that this one mates with, unless the face's own entry describes its contents.
    pub fn mates(&self) -> Option<Entry<'a>> {
        let own = self.own.and_then(|own| own.get("mates"));
        let of_its_own = self.own.as_ref().and_then(first_of).is_some();
        own.or_else(|| self.all.filter(|_| !of_its_own)?.get("mates"))
    }

    /// The face's own section, then that of all faces.
    fn sections(&self) -> impl Iterator<Item = Section<'a>> {
        [self.own, self.all].into_iter().flatten()
    }

    /// The entry of the first of `keys` that the face's own section has, then that of all.
    fn get(&self, keys: &[&str]) -> Option<Entry<'a>> {
        self.sections()
            .find_map(|section| keys.iter().find_map(|key| section.get(key)))
    }

    /// The contents of a face without `mates`; `length` is the face's (m), `drawn` its line and
    /// arcs in the tile's drawn outline.
    pub fn content(
        &self,
        length: f64,
        drawn: (&Polyline, &Arcs),
        keys: MagnetKeys,
        span: Span,
    ) -> Result<FaceContent> {
        if let Some(fit) = self.own.and_then(|own| own.get("fit")) {
            return Err(fit.key_error(
                "`fit` draws a mate back, but this face has no `mates`",
                "add `mates = \"FACE\"`, or remove `fit`",
            ));
        }
        let profile = self.get(&["profile"]);
        let pattern = self.get(&["code", "magnets"]);
        let line = profile.as_ref().map(|entry| read_profile(entry, length));
        let magnets = pattern.as_ref().map(read_pattern);
        let keys = self.magnet_keys()?.over(keys);
        let (drawing, polyline, arcs) = match line.transpose()? {
            Some((drawing, line)) => {
                let arcs = drawing.arcs(&line);
                (Some(drawing), line, arcs)
            }
            None => (None, drawn.0.clone(), drawn.1.clone()),
        };
        Ok(FaceContent {
            polyline,
            arcs,
            profile: drawing,
            fit: 0.0,
            pattern: magnets.unwrap_or_else(|| Ok(Pattern::List(Vec::new())))?,
            keys,
            line_span: profile.map_or(span, |entry| entry.span()),
            fit_span: span,
            pattern_span: pattern.map_or(span, |entry| entry.span()),
        })
    }

    /// The contents of a face that mates with `partner`.
    pub fn mate_of(&self, partner: &FaceContent, mates: &Entry) -> Result<FaceContent> {
        let complement = partner.mate(mates.span());
        let keys = self.magnet_keys()?.over(complement.keys);
        let mut content = FaceContent { keys, ..complement };
        if let Some(fit) = self.get(&["fit"]) {
            content.fit = fit.number(quantity::FIT)?;
            content.fit_span = fit.span();
        }
        Ok(content)
    }

    /// The keys of the face's shield; a mate does not take over its partner's shield.
    pub fn shield_keys(&self) -> Result<ShieldKeys> {
        let mut keys = ShieldKeys::default();
        for section in self.sections() {
            keys = keys.over(ShieldKeys::read(&section, "`shield`")?);
        }
        Ok(keys)
    }

    fn magnet_keys(&self) -> Result<MagnetKeys> {
        let mut keys = MagnetKeys::default();
        for section in self.sections() {
            if let Some(magnet) = section.section("magnet", "`magnet`")? {
                magnet.allow(&MAGNET_KEYS);
                keys = keys.over(MagnetKeys::read(&magnet)?);
            }
        }
        Ok(keys)
    }
}

/// The first key of a face's entry that conflicts with `mates`.
fn first_of<'a>(section: &Section<'a>) -> Option<Entry<'a>> {
    let keys = ["code", "magnets", "profile"];
    keys.iter().find_map(|key| section.get(key))
}

/// Largest number of places for magnets on a face.
const MOST_PLACES: usize = 1000;

fn check_count(entry: &Entry, count: usize) -> Result<()> {
    if count <= MOST_PLACES {
        return Ok(());
    }
    let message = format!(
        "`{}` has {count} positions for magnets, more than {MOST_PLACES}",
        entry.key
    );
    Err(entry.error(message, "use at most a few tens of magnets per face"))
}

fn read_pattern(entry: &Entry) -> Result<Pattern> {
    if entry.key == "magnets" {
        let magnets = entry.array()?;
        check_count(entry, magnets.len())?;
        let magnets = magnets.iter().map(ListedMagnet::read);
        return Ok(Pattern::List(all(magnets)?));
    }
    let text = entry.string()?;
    check_count(entry, text.chars().count())?;
    let code = Barcode::parse(text).map_err(|error: BarcodeError| {
        let help = match error.character {
            'n' | 's' | 'u' | 'd' => format!("write {}", error.character.to_ascii_uppercase()),
            ' ' | '_' | '0' => "write . for a position without a magnet".to_owned(),
            'F' | 'f' => "if it stands for iron: pieces that are not magnetised are not modelled. Leave \
                the position empty, `.`; the other tile's magnet then pulls too little there. An iron \
                plate behind the magnets of a face is its `shield`"
                .to_owned(),
            _ => "use N for a north pole out, S for a south pole out, . for no magnet".to_owned(),
        };
        let span = entry.character_span(error.index);
        entry.source.error(span, error.to_string(), help)
    })?;
    let spans = (0..code.len()).map(|k| entry.character_span(k)).collect();
    Ok(Pattern::Code(code, spans))
}

/// Finds the face that a word or number names.
pub(super) fn find_face(names: &[Vec<String>], entry: &Entry, tile: &str) -> Result<usize> {
    let name = entry.name_or_number()?;
    let found = names.iter().position(|names| names.contains(&name));
    found.ok_or_else(|| {
        let known: Vec<_> = names.iter().map(|names| names[0].as_str()).collect();
        let message = format!("the {tile} tile has no face `{name}`");
        entry.error(message, nearest_help(&name, &known))
    })
}
