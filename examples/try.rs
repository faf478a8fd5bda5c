use nalgebra::Vector2;
use tilebind::potential::*;
use tilebind::tile::*;
use tilebind::*;
fn tile(code: &str) -> Tile {
    let h = 0.215;
    let v = |x: f64, y: f64| Vector2::new(x, y);
    let o = Outline::new(vec![v(h, -h), v(h, h), v(-h, h), v(-h, -h)]).unwrap();
    let vs = o.vertices().to_vec();
    let mut faces = vec![];
    let mut magnets = vec![];
    for i in 0..4 {
        let f = Face {
            name: format!("{i}"),
            start: vs[i],
            end: vs[(i + 1) % 4],
        };
        for (k, c) in code.chars().enumerate() {
            let n = f.normal();
            let a = n.y.atan2(n.x) + if c == 'N' { 0.0 } else { std::f64::consts::PI };
            magnets.push(Magnet {
                position: f.point((k as f64 - 1.5) * 0.04, -0.005),
                angle: a,
                moment: 1.2 * 3e-7 / tilebind::units::MU0,
                size: [0.01, 0.01, 0.003],
                face: i,
            });
        }
        faces.push(f);
    }
    Tile {
        outline: o,
        faces,
        magnets,
        mass: 0.1,
        thickness: 0.013,
    }
}
fn problem_dist(a: &Configuration, b: &Configuration) -> f64 {
    let s = a.step_to(b);
    (s.x * s.x + s.y * s.y + s.z * s.z * 0.031).sqrt()
}
fn main() {
    let a = tile("NNNS");
    let b = tile("NSSS");
    let space = ConfigurationSpace {
        half_size: [1.0, 1.0],
        rho: b.radius_of_gyration(),
        free_distance: a.outline.circumradius() + b.outline.circumradius(),
    };
    let p = Problem::of_tiles(
        space,
        &a,
        &b,
        Box::new(DipolePotential::new(&a.magnets, &b.magnets)),
    );

    use roadmap::*;
    let t = std::time::Instant::now();
    let n: usize = std::env::args().nth(1).map_or(8000, |s| s.parse().unwrap());
    let seed: u64 = std::env::args().nth(2).map_or(1, |s| s.parse().unwrap());
    let es = EdgeSettings {
        tolerance: ProfileTolerance {
            relative: 0.01,
            absolute: 1e-6,
        },
        thermal_energy: 1e-3,
        probability_step: 5e-3,
    };
    let ms = MilestoneSettings {
        count: n,
        acceptance: Acceptance::Linear {
            lowest: -0.065,
            highest: 0.0065,
        },
        seed,
    };
    let m = milestone::milestones(&p, &ms);
    println!(
        "milestones {} {:?} evals {}",
        m.len(),
        t.elapsed(),
        p.evaluations()
    );
    let k = neighbour::neighbours_per_milestone(n);
    let pairs = neighbour::neighbour_pairs(&m, &p.space, k);
    println!("pairs {} k {k} {:?}", pairs.len(), t.elapsed());
    let e = edge::edges(&p, &m, &pairs, &es);
    println!(
        "edges {} {:?} evals {}",
        e.len(),
        t.elapsed(),
        p.evaluations()
    );
    let r = Roadmap {
        milestones: m,
        edges: e,
    };
    let ss = landscape::survey::SurveySettings {
        edge: es,
        settled: 0.005,
        added_milestones: 100,
        most_rounds: 6,
        seed,
    };
    let images = |q: &Configuration| {
        let mut v = vec![];
        for g in 0..4 {
            for h in 0..4 {
                let a = std::f64::consts::FRAC_PI_2 * g as f64;
                let b = std::f64::consts::FRAC_PI_2 * h as f64;
                let (s, c) = a.sin_cos();
                v.push(Configuration::from([
                    c * q.x - s * q.y,
                    s * q.x + c * q.y,
                    q.theta + a - b,
                ]));
            }
        }
        v
    };
    let s = landscape::survey::Survey::new(&p, &r, &[[0.43, 0.0, 0.0].into()], &images, &ss);
    println!(
        "survey {:?} evals {} states {} ts {} rounds {} unpolished {}",
        t.elapsed(),
        p.evaluations(),
        s.states.len(),
        s.transition_states.len(),
        s.rounds,
        s.unpolished.len()
    );
    let tree = s.network.minimax_tree();
    let merges = s.merges();
    let mut esc: Vec<(f64, f64, bool, Configuration)> = s
        .states
        .iter()
        .filter_map(|st| {
            let m = merges.iter().find(|m| m.upper == st.node)?;
            let e = s.network.links[m.link].costs.peak;
            Some((
                st.minimum.point.energy * 1e3,
                e * 1e3,
                s.transition_states.iter().any(|t| t.1 == m.link),
                s.network.peak_configuration(m.link)?,
            ))
        })
        .collect();
    esc.sort_by(|a, b| a.0.total_cmp(&b.0));
    for x in &esc {
        println!("ESC {:.5} {:.6} {} {:?}", x.0, x.1, x.2, x.3.to_array());
    }
    for t in s.transition_states.iter() {
        if let landscape::network::Way::Points(p) = &s.network.links[t.1].way {
            if p.len() > 12000 {
                for i in (0..p.len()).step_by(400) {
                    println!(
                        "WAY {i} {:?} {:.6e} step {:.3e} g {:?}",
                        p[i].q.to_array(),
                        p[i].energy * 1e3,
                        if i > 0 {
                            problem_dist(&p[i - 1].q, &p[i].q)
                        } else {
                            0.0
                        },
                        p[i].gradient.as_slice()
                    );
                }
                break;
            }
        }
    }
    println!("lens {:?}", {
        let mut v: Vec<usize> = s
            .transition_states
            .iter()
            .map(|t| match &s.network.links[t.1].way {
                landscape::network::Way::Points(p) => p.len(),
                _ => 0,
            })
            .collect();
        v.sort();
        v
    });
    let mut v: Vec<_> = s
        .states
        .iter()
        .map(|st| {
            let b = tree.bottleneck(st.node, s.free);
            let e = b.map(|b| s.network.links[b].costs.peak);
            (st.minimum.point.energy, st.minimum.point.q, e, b)
        })
        .collect();
    v.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut last = f64::NAN;
    let mut c = 0;
    for x in &v {
        if (x.0 - last).abs() < 1e-9 {
            c += 1;
        } else {
            if c > 0 {
                println!("     x{c}");
            }
            c = 1;
            last = x.0;
            println!(
                "{:.5} mJ {:?} free saddle {:?} ts {}",
                x.0 * 1e3,
                x.1,
                x.2.map(|e| e * 1e3),
                x.3.is_some_and(|b| s.transition_states.iter().any(|t| t.1 == b))
            );
        }
    }
    println!("     x{c}");
}
