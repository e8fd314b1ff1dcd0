set terminal pngcairo size 640,560 font 'DejaVu Sans,11'
set output 'work_precision_elastica.png'
set border 3 lw 1
set tics nomirror out scale 0.6
set grid lc rgb '#e4e4e4' lw 1
set logscale xy
set format '10^{%T}'
set bmargin 9
set key at screen 0.5,0.03 center bottom vertical maxrows 5 samplen 2.5 font ',9'
set xlabel 'run time [s]'
set ylabel 'relative error'
$front_0_0 << EOD
0.02197 0.109709
0.03127 0.0336019
0.05007 0.0335875
0.05014 0.00985221
0.08979 0.00236583
0.1747 0.000350163
EOD
$published_0_0 << EOD
EOD
$all_0_0 << EOD
0.8678 0.000350163
0.1747 0.000350163
0.1996 0.000485948
0.2228 0.00668118
0.1232 0.0336019
0.03127 0.0336019
0.02197 0.109709
0.05007 0.0335875
0.2102 0.00985221
0.05014 0.00985221
0.03521 0.359256
0.05456 0.0131563
0.357 0.00236583
0.08979 0.00236583
0.06227 0.271274
0.07646 0.0129979
EOD
$all_0_1 << EOD
110.3 1.51056
28.99 2.18176
12.28 3.62433
9.249 3.44449
2.408 0.0201573
0.6609 0.0201596
0.2469 0.0201336
0.1365 0.0190245
7.259 0.0801141
1.645 0.0796966
0.7935 0.0788659
0.4001 0.0794137
17.99 0.38165
7.126 0.377355
3.628 0.381293
2.45 0.424028
EOD
$best_0_0 << EOD
0.02197 0.109709
0.03127 0.0336019
0.05007 0.0335875
0.05014 0.00985221
0.08979 0.00236583
0.1747 0.000350163
EOD
$best_0_1 << EOD
0.1365 0.0190245
EOD
set title 'Heavy elastica' noenhanced
plot $front_0_0 with lines lw 9 lc rgb '#d0d0d0' title 'best of all', \
  $all_0_0 with points pt 7 ps 0.5 lc rgb '#000000' notitle, \
  $all_0_1 with points pt 7 ps 0.5 lc rgb '#d55e00' notitle, \
  $best_0_0 with lines lw 1.6 lc rgb '#000000' dt 1 title 'vertex' noenhanced, \
  $best_0_1 with lines lw 1.6 lc rgb '#d55e00' dt 1 title 'grid' noenhanced
