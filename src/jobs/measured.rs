//! Columns of numbers with a unit: in the column's name (`x_mm`), or in each entry (`12 mm`).

use csv::StringRecord;

use crate::design;
use crate::text::column;

/// A kind of quantity in a table.
#[derive(Clone, Copy)]
pub(crate) struct Measured {
    /// Endings of a column's name, and the units that they mean; the SI unit first.
    endings: &'static [(&'static str, &'static str)],
    read: fn(&str) -> Option<f64>,
}

pub(crate) const LENGTH: Measured = Measured {
    endings: &[
        ("m", "m"),
        ("mm", "mm"),
        ("cm", "cm"),
        ("um", "um"),
        ("in", "in"),
    ],
    read: design::length,
};
pub(crate) const ANGLE: Measured = Measured {
    endings: &[("rad", "rad"), ("deg", "deg"), ("mrad", "mrad")],
    read: design::angle,
};
pub(crate) const SPEED: Measured = Measured {
    endings: &[("m_s", "m/s"), ("mm_s", "mm/s"), ("cm_s", "cm/s")],
    read: design::speed,
};
pub(crate) const SPIN: Measured = Measured {
    endings: &[("rad_s", "rad/s"), ("deg_s", "deg/s"), ("rpm", "rpm")],
    read: design::spin,
};

/// A column that was found.
#[derive(Clone, Copy)]
pub(crate) struct Column {
    /// Its index.
    pub place: usize,
    unit: &'static str,
    read: fn(&str) -> Option<f64>,
}

impl Measured {
    /// The column of this name, alone or with a unit: `x`, `x_mm`.
    ///
    /// # Errors
    /// If there are two.
    pub fn column(&self, header: &StringRecord, name: &str) -> Result<Option<Column>, String> {
        let with_unit = |(ending, _): &(&str, &str)| format!("{name}_{ending}");
        let long: Vec<String> = self.endings.iter().map(with_unit).collect();
        let names: Vec<&str> = [name]
            .into_iter()
            .chain(long.iter().map(String::as_str))
            .collect();
        let place = column(header, &names)?;
        Ok(place.map(|place| {
            let at = long.iter().position(|it| *it == header[place]);
            Column {
                place,
                unit: self.endings[at.unwrap_or(0)].1,
                read: self.read,
            }
        }))
    }
}

impl Column {
    /// The number (SI) of an entry: a plain one has the column's unit.
    pub fn number(&self, entry: &str) -> Option<f64> {
        match entry.trim().parse::<f64>() {
            Ok(_) => (self.read)(&format!("{} {}", entry.trim(), self.unit)),
            Err(_) => (self.read)(entry),
        }
    }

    /// The unit of plain numbers.
    pub fn unit(&self) -> &'static str {
        self.unit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_from_names_and_entries() {
        let header = StringRecord::from(vec!["x_mm", "theta_deg", "omega"]);
        let x = LENGTH.column(&header, "x").unwrap().unwrap();
        let theta = ANGLE.column(&header, "theta").unwrap().unwrap();
        let omega = SPIN.column(&header, "omega").unwrap().unwrap();
        assert_eq!(
            (x.number("-12"), x.number("3 cm")),
            (Some(-0.012), Some(0.03))
        );
        assert_eq!(theta.number("180"), Some(std::f64::consts::PI));
        assert_eq!((omega.number("2"), omega.number("2 m")), (Some(2.0), None));
        let twice = StringRecord::from(vec!["x", "x_mm"]);
        assert!(LENGTH.column(&twice, "x").is_err());
    }
}
