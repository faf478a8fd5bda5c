//! Small designs of any kind, for analyses of many of them.

/// A design with a few faces, shapes and magnets: each byte is one choice; missing ones are 0.
pub fn of(bytes: &[u8]) -> String {
    let mut bytes = bytes.iter().copied();
    let mut next = |count: usize| usize::from(bytes.next().unwrap_or_default()) % count;
    let side = [0.04, 0.08, 0.43][next(3)];
    let model = ["dipole", "cuboid"][next(2)];
    let sides = 3 + next(4);
    let form = ["", "shape = \"disc\"", "axis = \"up\""][next(3)];
    let letters = if next(2) == 1 && form.contains("up") {
        "UD"
    } else {
        "NS."
    };
    let letters: Vec<char> = letters.chars().collect();
    let size = match form.contains("disc") {
        true => "diameter = 0.004\nheight = 0.002".to_owned(),
        false => format!("size = [{}, 0.004, 0.003]", [0.002, 0.004, 0.008][next(3)]),
    };
    let mut text = format!(
        "name = \"fuzz\"\n[table]\nsize = [2.0, 2.0]\n[magnet]\n{size}\n{form}\nremanence = 1.2\n\
         pitch = {}\ninset = {}\n[potential]\nmodel = \"{model}\"\n",
        side / [4.0, 6.0][next(2)],
        [0.0, 0.001, 0.0001][next(3)],
    );
    let target = next(sides);
    for tile in ["fixed", "moving"] {
        text += &format!(
            "[{tile}]\nsides = {sides}\nside = {side}\nthickness = 0.013\nmass = 0.1\n[{tile}.faces]\n"
        );
        for face in 0..sides {
            let code: String = (0..next(4)).map(|_| letters[next(letters.len())]).collect();
            let profile = match next(6) {
                0 => format!(
                    "profile = {{ shape = \"tab\", width = {}, depth = {}, draft = {} }}",
                    side / [2.0, 3.0][next(2)],
                    side / [20.0, -20.0, 8.0][next(3)],
                    [0.3, 0.0, -0.2][next(3)],
                ),
                1 => format!(
                    "profile = {{ shape = \"teeth\", count = {}, depth = {}, form = \"{}\" }}",
                    1 + next(3),
                    side / [20.0, 40.0][next(2)],
                    ["sine", "triangle", "square"][next(3)],
                ),
                _ => String::new(),
            };
            let code = match code.is_empty() {
                true => String::new(),
                false => format!("code = \"{code}\""),
            };
            let entry = match (tile, face == target) {
                ("moving", true) => "mates = \"0\"".to_owned(),
                _ => [code, profile]
                    .into_iter()
                    .filter(|it| !it.is_empty())
                    .collect::<Vec<_>>()
                    .join(", "),
            };
            text += &format!("{face} = {{ {entry} }}\n");
        }
    }
    text + &format!("[target]\nfixed = 0\nmoving = {target}\n")
}
