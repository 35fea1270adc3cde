# SPDX-License-Identifier: GPL-3.0-or-later
# How far water's E(t, r_0) is off after how much work: omega-error-against-time.png from out/METHOD-SEED/course.tsv.
set terminal pngcairo size 1400, 860 font "Liberation Sans,13" fontscale 2 linewidth 2 pointscale 2 background "#ffffff"
set output "omega-error-against-time.png"
set encoding utf8
set datafile separator tab
set border 3 linewidth 0.8 linecolor rgb "#222222"
set tics nomirror out scale 0.6
set grid ytics linetype 1 linewidth 0.5 linecolor rgb "#e4e4e4"
set logscale xy
set rmargin 3
set xrange [4:200]
set xtics (5, 10, 20, 50, 100, 200)
set yrange [0.003:0.2]
set ytics (0.005, 0.01, 0.02, 0.05, 0.1, 0.2)
set xlabel "processor time / s"
set ylabel "error of {/:Italic E}({/:Italic t}, {/:Italic r}_0), rms"
set key off

courses(method) = system("ls out/".method."-[0-9]/course.tsv")
# Of the seeds of a method, the k-th points: mean time; least, mean and largest error. Seeds of fewer points end earlier.
band(method) = "< awk -F '\t' '!/^#/ { k = FNR; if (k > last) last = k; n[k]++; t[k] += log($2); s[k] += log($3); \
    if (n[k] == 1 || $3 < low[k]) low[k] = $3; if (n[k] == 1 || $3 > high[k]) high[k] = $3; if (FILENAME != file) files++; file = FILENAME } \
    END { for (k = 2; k <= last; k++) if (n[k] == files) print exp(t[k] / n[k]) \"\t\" low[k] \"\t\" exp(s[k] / n[k]) \"\t\" high[k] }' " . \
    system("echo out/".method."-[0-9]/course.tsv")

stats "< grep -hv '^#' out/*-[0-9]/course.tsv" using 4 name "N" nooutput
set object 1 rectangle from graph 0, graph 0 to graph 1, first N_mean fillcolor rgb "#ececec" fillstyle solid noborder behind
set label 1 "noise" at graph 0.98, first 0.0037 right textcolor rgb "#777777"
stats "< grep -hv '^#' out/linear-[0-9]/course.tsv" using 3 name "L" nooutput
set arrow 1 from graph 0, first L_mean to graph 1, first L_mean nohead dashtype 3 linewidth 1.2 linecolor rgb "#777777"
set label 2 "without any fit: linear {/:Italic ω}" at graph 0.98, first 1.15 * L_mean right textcolor rgb "#777777"

methods = "original five cma-es gauss-newton memory"
colours = "#7a7a7a #d55e00 #009e73 #56b4e9 #0072b2"
array name[5] = ["genetic, as in the thesis", "the same, five genes", "CMA-ES", "Gauss-Newton", "Gauss-Newton, with memory"]
array at_time[5] = [103, 12, 7.5, 24, 68]
array at_error[5] = [0.044, 0.0235, 0.135, 0.105, 0.0088]
do for [k = 1:5] { set label 10 + k name[k] at at_time[k], at_error[k] center textcolor rgb word(colours, k) }
plot for [k = 1:5] band(word(methods, k)) using 1:2:4 with filledcurves fillcolor rgb word(colours, k) fillstyle transparent solid 0.2 noborder, \
    for [k = 1:5] band(word(methods, k)) using 1:3 with linespoints linewidth 2.4 pointtype 7 pointsize 0.75 linecolor rgb word(colours, k)
