set terminal pngcairo size 640,560 font 'DejaVu Sans,11'
set output 'work_precision_chain_swing.png'
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
0.0649 0.585916
0.08004 0.00912783
0.2126 0.00130949
0.3053 0.000178216
0.5809 2.67551e-05
1.229 4.78779e-06
2.251 4.28954e-06
EOD
$published_0_0 << EOD
0.5097 0.372427
0.2771 0.371329
EOD
$all_0_0 << EOD
2.251 4.28954e-06
1.133 2.81719e-05
0.568 0.000202621
0.2769 0.00149581
0.1505 0.00986332
1.229 4.78779e-06
0.5809 2.67551e-05
0.3053 0.000178216
0.2126 0.00130949
0.08004 0.00912783
EOD
$all_0_1 << EOD
2.12 0.133295
1.028 0.232651
0.5097 0.372427
0.2567 0.51791
0.1362 0.586922
1.075 0.132475
0.5301 0.231665
0.2771 0.371329
0.1322 0.516783
0.0649 0.585916
EOD
$all_0_2 << EOD
28.31 0.138457
14.95 0.230857
8.624 0.368149
4.857 0.513994
2.839 0.58408
16.18 0.181744
9.498 0.244685
5.463 0.365471
2.774 0.504918
1.633 0.575782
EOD
$best_0_0 << EOD
0.08004 0.00912783
0.2126 0.00130949
0.3053 0.000178216
0.5809 2.67551e-05
1.229 4.78779e-06
2.251 4.28954e-06
EOD
$best_0_1 << EOD
0.0649 0.585916
0.1322 0.516783
0.2771 0.371329
0.5301 0.231665
1.075 0.132475
EOD
$best_0_2 << EOD
1.633 0.575782
2.774 0.504918
5.463 0.365471
9.498 0.244685
14.95 0.230857
16.18 0.181744
28.31 0.138457
EOD
set title 'Swinging chain' noenhanced
plot $front_0_0 with lines lw 9 lc rgb '#d0d0d0' title 'best of all', \
  $all_0_0 with points pt 7 ps 0.5 lc rgb '#000000' notitle, \
  $all_0_1 with points pt 7 ps 0.5 lc rgb '#d55e00' notitle, \
  $all_0_2 with points pt 7 ps 0.5 lc rgb '#0072b2' notitle, \
  $best_0_0 with lines lw 1.6 lc rgb '#000000' dt 1 title 'second order' noenhanced, \
  $best_0_1 with lines lw 1.6 lc rgb '#d55e00' dt 1 title 'backward Euler' noenhanced, \
  $best_0_2 with lines lw 1.6 lc rgb '#0072b2' dt 1 title 'grid' noenhanced, \
  $published_0_0 with points pt 6 ps 2.4 lw 2 lc rgb '#000000' title 'published scheme'
