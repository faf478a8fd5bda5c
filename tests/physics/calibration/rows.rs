//! Reading tables of measurements.

use tilebind::Configuration;
use tilebind::calibration::read_rows;

#[test]
fn a_table_is_read() {
    let text = "# bench of May\nx_m, y_m, theta_rad, iron, force_x_N, energy_J\n\
                0.43,0,0.1,1,-2.5,\n\n0.44,0.01,-0.1,0,,-1e-3\n";
    let rows = read_rows(text).unwrap();
    assert_eq!((rows[0].line, rows[1].line), (3, 5));
    assert!(rows[0].iron && !rows[1].iron);
    assert_eq!(rows[0].measured, [None, Some(-2.5), None, None]);
    assert_eq!(rows[1].measured, [Some(-1e-3), None, None, None]);
    assert_eq!(rows[1].configuration, Configuration::new(0.44, 0.01, -0.1));
}

#[test]
fn a_table_from_a_spreadsheet_is_read() {
    let text = "\u{feff}\"x_m\",\"y_m\",\"theta_rad\",\"iron\",\"energy_J\"\r\n\r\n,,,,\r\n  \r\n\
                # of \"May\r\n  # and, \"June\r\n\"0.43\",0,0.1,1,\"2\" \r\n0.44,0,0.1,0,3";
    let rows = read_rows(text).unwrap_or_else(|error| panic!("{error}"));
    let read: Vec<_> = rows.iter().map(|row| (row.line, row.measured[0])).collect();
    assert_eq!(read, [(7, Some(2.0)), (8, Some(3.0))]);
}

#[test]
fn wrong_tables_are_refused_with_the_place() {
    let message = |text: &str| read_rows(text).unwrap_err().to_string();
    assert!(message("").contains("x_m,y_m"));
    assert!(message("x_m,y_m,theta,iron").contains("`theta`"));
    assert!(message("x_m,y_m,iron,energy_J").contains("`theta_rad`"));
    assert!(message("x_m,y_m,theta_rad,iron").contains("there are no measurements"));
    assert!(message("x_m,x_m").contains("twice"));
    let head = "x_m,y_m,theta_rad,iron,energy_J\n";
    assert!(message(head).contains("no rows"));
    assert!(message(&format!("{head}1,2,3")).starts_with("line 2 has 3 entries"));
    assert!(message(&format!("{head}1,2,NaN,1,4")).contains("theta_rad"));
    assert!(message(&format!("{head}1,2,3,0.5,4")).contains("must be 1"));
    assert!(message(&format!("{head}1,,3,1,4")).contains("y_m"));
}
