# Draws planner.csv (bench_planner): speed against synchronisation. Variables: csv, out.
set terminal svg size 1100,480 font 'DejaVu Sans,13' background '#ffffff'
set output out
set datafile separator ','
set logscale x
set xlabel 'period k, ms'
set xrange [1.5:700]
set grid
set key bottom right samplen 1
# 1 scheme, 2 n/k, 3 k ms, 5 work a second, 6 work a CPU second, 7 ms to exhaustion, 8 percent waited
col(s, n, c) = (stringcolumn(1) eq s && abs(column(2) - n) < 0.001) ? column(c) : NaN
level(s, c) = system(sprintf("awk -F, '$1 == \"%s\" { print $%d }' '%s'", s, c, csv)) + 0
set multiplot layout 1,2 title 'Two workers: windows of period k and length n against a queue under a lock, stealing, and batches'
set ylabel 'expansions and simulations, thousands a second'
set yrange [0:*]
plot csv skip 1 using 3:(col('windows', 0.04, 5) / 1000) with linespoints pt 7 lc 1 title 'windows, n = 0.04 k', \
	csv skip 1 using 3:(col('windows', 0.33, 5) / 1000) with linespoints pt 5 lc 2 title 'windows, n = 0.33 k', \
	level('steal', 5) / 1000 lc 3 lw 2 title 'stealing', level('queue', 5) / 1000 lc 4 lw 2 title 'queue', \
	level('batch', 5) / 1000 lc 7 lw 2 title 'batches'
set ylabel 'ms to exhaustion'
plot csv skip 1 using 3:(col('windows', 0.04, 7)) with linespoints pt 7 lc 1 title 'windows, n = 0.04 k', \
	csv skip 1 using 3:(col('windows', 0.33, 7)) with linespoints pt 5 lc 2 title 'windows, n = 0.33 k', \
	level('steal', 7) lc 3 lw 2 title 'stealing', level('queue', 7) lc 4 lw 2 title 'queue', level('batch', 7) lc 7 lw 2 title 'batches'
unset multiplot
