# SPDX-License-Identifier: GPL-3.0-or-later
# settings.xml of one of VOTCA's tutorials with LAMMPS in place of GROMACS: -v method=ibi, and of molecules
# -v topology=topol.xml. Without its convergence check, since run.sh counts the iterations.
/<name>/ { split($0, part, /[<>]/); name = part[3] }
/<(non-)?bonded>/ { of_interaction = 1 }
/<\/(non-)?bonded>/ { of_interaction = 0 }
/<convergence_check>/ { skipped = 1 }
/<gromacs>/ {
    skipped = 1
    if (of_interaction) {
        # LAMMPS has Å and kcal/mol; an angle's table is in degrees, by VOTCA itself.
        scale = "<scale>10</scale>"
        grid = "<table_begin>0.2</table_begin><table_bins>0.002</table_bins>"
        if (name == "bond") grid = "<table_begin>0.15</table_begin><table_end>0.4</table_end><table_bins>0.0005</table_bins>"
        if (name == "angle") { scale = ""; grid = "<table_bins>0.005</table_bins>" }
        print "<lammps><table>" name ".table</table>" scale "<y_scale>0.239006</y_scale>" grid "</lammps>"
    } else {
        print "<lammps><script>system.in</script><topol>" (topology ? topology : "conf.gro") "</topol>"
        print "<traj>traj.dump</traj></lammps><simulation><tasks>1</tasks></simulation>"
        print "<initial_configuration>maindir</initial_configuration>"
    }
}
!skipped {
    sub(/<method>[^<]*/, "<method>" method)
    sub(/<program>gromacs/, "<program>lammps")
    sub(/<post_add>convergence/, "<post_add>")
    sub(/<filelist>[^<]*/, "<filelist>system.in system.data conf.gro " topology)
    print
}
/<\/gromacs>/ || /<\/convergence_check>/ { skipped = 0 }
