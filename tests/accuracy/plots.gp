# SPDX-License-Identifier: MIT
# Error against cost, from pictures.csv in the current folder to SVG files there.
set datafile separator ","
set datafile columnheaders
set terminal svg size 900,600 font "sans,14" background "white"
set logscale xy
set grid
set key outside right
set ylabel "relative RMSE of 4x4-pixel blocks [%]"
scenes = system("tail -n +2 pictures.csv | cut -d, -f1 | sort -u")

set output "error_by_time.svg"
set xlabel "processor time, handlers compiled natively [s]"
plot for [scene in scenes] "pictures.csv" using (strcol("scene") eq scene ? column("CPU [s]") : NaN):(column("RMSE without it [%]")) with linespoints linewidth 2 title scene noenhanced

set output "error_by_records.svg"
set xlabel "records of the radiosity stage"
plot for [scene in scenes] "pictures.csv" using (strcol("scene") eq scene ? column("records") : NaN):(column("RMSE without it [%]")) with linespoints linewidth 2 title scene noenhanced
