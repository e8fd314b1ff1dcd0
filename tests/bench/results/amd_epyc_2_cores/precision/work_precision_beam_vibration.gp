set terminal pngcairo size 640,560 font 'DejaVu Sans,11'
set output 'work_precision_beam_vibration.png'
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
0.02804 0.0747647
0.07298 0.0196401
0.1122 0.00706298
0.2237 0.00194454
0.5315 0.00050229
EOD
$published_0_0 << EOD
0.183 0.601795
0.1023 0.600798
EOD
$all_0_0 << EOD
0.9927 0.000511095
0.4764 0.00195997
0.2218 0.00708971
0.1256 0.0197032
0.05519 0.0749346
0.5315 0.00050229
0.2237 0.00194454
0.1122 0.00706298
0.07298 0.0196401
0.02804 0.0747647
EOD
$all_0_1 << EOD
0.7551 0.270795
0.3715 0.435598
0.183 0.601795
0.09798 0.690953
0.04546 0.706389
0.4 0.270288
0.2016 0.434816
0.1023 0.600798
0.05317 0.689901
0.03221 0.705346
EOD
$all_0_2 << EOD
4.165 0.843811
3.425 1.10866
2.989 1.6844
2.028 2.67258
1.301 3.95332
3.409 0.476376
1.635 0.670645
1.233 1.0073
0.7589 1.38813
0.5984 1.64511
EOD
$best_0_0 << EOD
0.02804 0.0747647
0.07298 0.0196401
0.1122 0.00706298
0.2237 0.00194454
0.5315 0.00050229
EOD
$best_0_1 << EOD
0.03221 0.705346
0.05317 0.689901
0.1023 0.600798
0.2016 0.434816
0.4 0.270288
EOD
$best_0_2 << EOD
0.5984 1.64511
0.7589 1.38813
1.233 1.0073
1.635 0.670645
3.409 0.476376
EOD
set title 'Vibration of a clamped yarn' noenhanced
plot $front_0_0 with lines lw 9 lc rgb '#d0d0d0' title 'best of all', \
  $all_0_0 with points pt 7 ps 0.5 lc rgb '#000000' notitle, \
  $all_0_1 with points pt 7 ps 0.5 lc rgb '#d55e00' notitle, \
  $all_0_2 with points pt 7 ps 0.5 lc rgb '#0072b2' notitle, \
  $best_0_0 with lines lw 1.6 lc rgb '#000000' dt 1 title 'second order' noenhanced, \
  $best_0_1 with lines lw 1.6 lc rgb '#d55e00' dt 1 title 'backward Euler' noenhanced, \
  $best_0_2 with lines lw 1.6 lc rgb '#0072b2' dt 1 title 'grid' noenhanced, \
  $published_0_0 with points pt 6 ps 2.4 lw 2 lc rgb '#000000' title 'published scheme'
