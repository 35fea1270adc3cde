# SPDX-License-Identifier: GPL-3.0-or-later
# How far water's g(r) is off after how much work: error-against-time.png from out/METHOD-SEED/course.tsv of five methods.
set terminal pngcairo size 1400, 860 font "Liberation Sans,13" fontscale 2 linewidth 2 pointscale 2 background "#ffffff"
set output "error-against-time.png"
set encoding utf8
set datafile separator tab
set border 3 linewidth 0.8 linecolor rgb "#222222"
set tics nomirror out scale 0.6
set grid ytics linetype 1 linewidth 0.5 linecolor rgb "#e4e4e4"
set logscale xy
set rmargin 3
set xrange [1:1200]
set xtics (1, 2, 5, 10, 20, 50, 100, 200, 500)
set yrange [0.0014:1]
set ytics (0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1)
set xlabel "processor time / s"
set ylabel "error of {/:Italic g}({/:Italic r}), rms"
set key off

# Of the seeds of a method, the k-th points: mean time of those that go on; least, mean and largest error, a seed that
# has ended staying as it is.
band(method) = "< awk -F '\t' 'FNR == 1 { seeds++ } !/^#/ { n[seeds]++; t[seeds, n[seeds]] = log($2); e[seeds, n[seeds]] = log($3); if (n[seeds] > last) last = n[seeds] } \
    END { for (k = 1; k <= last; k++) { time = going = sum = 0; \
        for (s = 1; s <= seeds; s++) { i = k < n[s] ? k : n[s]; if (k <= n[s]) { time += t[s, k]; going++ } \
            sum += e[s, i]; if (s == 1 || e[s, i] < low) low = e[s, i]; if (s == 1 || e[s, i] > high) high = e[s, i] } \
        print exp(time / going) \"\t\" exp(low) \"\t\" exp(sum / seeds) \"\t\" exp(high) } }' " . \
    system("echo out/".method."-[0-9]/course.tsv")

stats "< grep -hv '^#' out/imc-[0-9]/course.tsv" using 4 name "N" nooutput
set object 1 rectangle from graph 0, graph 0 to graph 1, first N_mean fillcolor rgb "#ececec" fillstyle solid noborder behind
set label 1 "noise: differences cannot be told here" at graph 0.98, first 0.00165 right textcolor rgb "#777777"
set arrow 1 from graph 0, first 0.113 to graph 1, first 0.113 nohead dashtype 3 linewidth 1.2 linecolor rgb "#777777"
set label 2 "without any fit:\n{/:Italic Φ} = −{/:Italic k}_B{/:Italic T} ln {/:Italic g}" at 1150, 0.2 right textcolor rgb "#777777"

methods = "original memetic gauss-newton ibi imc"
colours = "#7a7a7a #d55e00 #56b4e9 #009e73 #0072b2"
array name[5] = ["genetic, as in the thesis", "genetic, today", "Gauss-Newton", "iterative Boltzmann inversion", "inverse Monte Carlo"]
array at_time[5] = [62, 185, 42, 7.6, 17.5]
array at_error[5] = [0.55, 0.0145, 0.0068, 0.0039, 0.0027]
do for [k = 1:5] { set label 10 + k name[k] at at_time[k], at_error[k] left textcolor rgb word(colours, k) }
plot for [k = 1:5] band(word(methods, k)) using 1:2:4 with filledcurves fillcolor rgb word(colours, k) fillstyle transparent solid 0.2 noborder, \
    for [k = 1:5] band(word(methods, k)) using 1:3 with linespoints linewidth 2.4 pointtype 7 pointsize 0.75 linecolor rgb word(colours, k)
