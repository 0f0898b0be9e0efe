# Draws search.csv (bench_search): what the best proposal is worth after so much time; a column per position, cost above, success below. Variables: csv, out.
set terminal svg size 1750,800 font 'DejaVu Sans,12' background '#ffffff'
set output out
set datafile separator ','
set logscale x
set format x '%g'
set xrange [0.005:2000]
set grid
# 1 position, 2 model, 3 depth, 4 rails, 5 shots, 6 ms, 7 cost, 8 success
pick(p, m, d, r, c) = (stringcolumn(1) eq p && stringcolumn(2) eq m && column(3) == d && column(4) == r && column(5) == d) ? column(c) : NaN
positions = '"situation1" "situation2" "break 1" "break 3" "break 5"'
models = 'thesis real'
set multiplot layout 2,5 title 'Best proposal against time: filled one shot deep, open two; thick without cushions, thin with three'
do for [row=1:2] {
	do for [k=1:5] {
		p = word(positions, k)
		set title (row == 1 ? p : '')
		set xlabel (row == 2 ? 'time, ms' : '')
		set ylabel (k == 1 ? (row == 1 ? 'cost' : 'probability of success') : '')
		set yrange [0:(row == 1 ? 4 : 1)]
		if (k == 5 && row == 1) { set key top right samplen 1 } else { set key off }
		plot for [m=1:2] for [d=1:2] for [r=0:1] csv skip 1 \
			using 6:(pick(p, word(models, m), d, 3 * r, 6 + row)) with linespoints \
			lc m lw (r == 0 ? 2.5 : 1) pt (d == 1 ? 7 : 6) ps 0.6 title word(models, m).', '.d.' deep, '.(3 * r).' cushions'
	}
}
unset multiplot
