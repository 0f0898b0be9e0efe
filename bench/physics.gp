# Draws physics.csv (bench_accuracy): time per shot against position error, one panel per family. Variables: csv, out.
set terminal svg size 1100,850 font 'DejaVu Sans,13' background '#ffffff'
set output out
set datafile separator ','
set logscale xy
set format x '%g'
set format y '10^{%L}'
set xlabel 'time per shot, µs'
set ylabel 'largest position error, m'
set xrange [0.5:20000]
set yrange [1e-13:50]
set grid
set key bottom right samplen 1 width -2
# 1 family, 2 solver, 3 tolerance, 4 us, 5 position error, 7 missed, 8 invented, 9 shots
col(f, s, c) = (stringcolumn(1) eq f && stringcolumn(2) eq s) ? column(c) : NaN
wrong(f, s) = (stringcolumn(1) eq f && stringcolumn(2) eq s && column(7) + column(8) > 0) ? sprintf('%d', column(7) + column(8)) : ''
set multiplot layout 2,2 title 'Speed against error; the numbers count shots with an event missed or invented'
do for [f in '"simple" "real" "real-mathavan" "hard pairs"'] {
	set title f
	plot for [i=1:4] s = word('"thesis formula" "GSL" "ours (plain)" "ours (engine)"', i) \
			csv skip 1 using (col(f, s, 4)):(col(f, s, 5) + 1e-13) with points pt (i == 4 ? 7 : 4 + i) ps 1.3 lc i title s, \
		for [i=1:4] s = word('"thesis formula" "GSL" "ours (plain)" "ours (engine)"', i) \
			csv skip 1 using (col(f, s, 4)):(col(f, s, 5) + 1e-13):(wrong(f, s)) with labels offset 1.5,0.5 notitle
}
unset multiplot
