# Analyses: dipoles and blocks, docking, certificates, moving tiles, figures for print.
tilebind analyse shapes/paper-tile.toml --milestones 120 --far-starts 5 --certify-cells 2000 --complete-cells 2000 --dynamics=20 --out target/dipoles
tilebind analyse shapes/tab-20mm.toml --model cuboid --milestones 80 --far-starts 4 --certify-cells 500 --complete-cells 500 --figure-width 85mm --figure-font 8 --figure-panels --out target/blocks
tilebind compare shapes/tab-20mm.toml shapes/tab-10mm.toml shapes/wrong-partner.toml --milestones 80 --far-starts 4 --certify-cells 300 --complete-cells 300 --out target/compare
tilebind sweep shapes/tab-20mm.toml --vary fixed.faces.east.profile.depth=0.01:0.03:3 --milestones 80 --far-starts 4 --certify-cells 200 --complete-cells 0 --baseline depth=0.01 --out target/sweep
tilebind sweep shapes/tab-20mm.toml --vary fixed.faces.east.profile.depth=0.01,0.03 --vary magnet.inset=0,0.003 --milestones 60 --far-starts 3 --certify-cells 100 --complete-cells 0 --out target/sweep-2
tilebind barrier shapes/tab-10mm.toml --from 0.43,0,0 --to 0.9,0,0 --tolerance 1e-4
tilebind energy shapes/halbach.toml --pose 0.43,0,0 --pose 0.5,0.1,0.3
tilebind match shapes/dogleg.toml --out target/match
tilebind match shapes/dogleg.toml --json
tilebind show shapes/hexagon.toml
tilebind show shapes/hexagon.toml --out target/hexagon.svg
tilebind show shapes/shielded-backs.toml --json
tilebind make shapes/dovetail.toml --kerf 0.2mm --out target/workshop
tilebind init target/mine.toml --sides 6 --side 12cm --magnets 3 --shape arc
# Rates and what is built on them.
tilebind bond shapes/tab-20mm.toml --kt 2e-3 --coverage 0.3 --out target/bond
tilebind rates shapes/paper-tile.toml --kt 8e-3 --start 0.43,-0.04,0 --out target/exit
tilebind rates shapes/paper-tile.toml --kt 1.2e-2 --traps 1 --out target/rates
tilebind yield shapes/paper-tile.toml --tiles 10 --time 600 --kt 3e-3,4e-3 --runs 8 --simulations 100 --out target/yield
tilebind dock shapes/paper-tile.toml --runs 400 --out target/dock
tilebind table shapes/paper-tile.toml --count 3,3 --time 3 --runs 2 --shaking 3e-3 --drag 0.5 --frames 0.5 --out target/table
# Words and tile sets.
tilebind words --length 6 --gap 0.4 --out target/words
tilebind words --length 6
tilebind words --length 8 --gap 0.5 --shape polar --flip --json
tilebind words --slots 12 --magnets 4 --pitch 0.015 --count 3 --seconds 1 --out target/slots
tilebind words --continuous --magnets 4 --pitch 0.02 --count 3 --seconds 1 --out target/continuous
tilebind crosstalk target/words/words.toml --out target/crosstalk
tilebind assemble lattice --lattice 2x2 --kt 7e-3 --coverage 0.1 --seconds 1 --out target/lattice
tilebind crosstalk target/words/words.toml --certify --json
tilebind assemble shapes/assemblies/sierpinski.yaml --length 8 --kt 5.4e-3 --coverage 0.1 --out target/sierpinski
