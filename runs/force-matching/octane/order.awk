# Molecule after molecule, C1 to C8, of a LAMMPS dump that has type after type: 250 CH3, then 750 CH2.
$1 + 0 > 0 && NF > 9 { line[$1] = $0; if (++n == 1000) { n = 0; write() } next }
{ print }
function write(m, k, id, text) {
    for (m = 0; m < 125; m++)
        for (k = 1; k <= 8; k++) {
            id = k == 1 ? 2 * m + 1 : k == 8 ? 2 * m + 2 : 250 + 6 * m + k - 1
            $0 = line[id]
            $1 = 8 * m + k
            $5 = "C" k
            print
        }
}
