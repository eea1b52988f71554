# SPDX-License-Identifier: MIT
# Error against cost, from pictures.csv in the current folder to SVG files there; the quality presets are marked.
set datafile separator ","
set datafile columnheaders
set terminal svg size 900,600 font "sans,14" background "white"
set logscale xy
set grid
set linetype 9 linecolor rgb "gray50"
set linetype 10 linecolor rgb "brown"
set key outside right
set ylabel "relative RMSE of 4x4-pixel blocks [%]"
set ytics (0.25, 0.5, 1, 2, 4, 8, 16, 32)
scenes = system("tail -n +2 pictures.csv | cut -d, -f1 | sort -u")
presets = "draft normal fine"

set output "error_by_time.svg"
set xlabel "processor time, handlers compiled natively [s]"
plot for [scene in scenes] "pictures.csv" using (strcol("scene") eq scene ? column("CPU [s]") : NaN):(column("RMSE without it [%]")) with linespoints pointtype 7 pointsize 0.4 linewidth 2 title scene noenhanced, \
     for [i=1:3] "pictures.csv" using (strcol("setting") eq word(presets, i) ? column("CPU [s]") : NaN):(column("RMSE without it [%]")) with points pointtype 2*i+2 pointsize 1.2 linecolor "black" title word(presets, i)

set output "error_by_records.svg"
set xlabel "records of the radiosity stage"
plot for [scene in scenes] "pictures.csv" using (strcol("scene") eq scene ? column("records") : NaN):(column("RMSE without it [%]")) with linespoints pointtype 7 pointsize 0.4 linewidth 2 title scene noenhanced, \
     for [i=1:3] "pictures.csv" using (strcol("setting") eq word(presets, i) ? column("records") : NaN):(column("RMSE without it [%]")) with points pointtype 2*i+2 pointsize 1.2 linecolor "black" title word(presets, i)
