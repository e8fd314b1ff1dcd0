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
0.00302494 0.0336019
0.0049398 0.00985221
0.00876368 0.00236583
0.0166915 0.000350163
0.152266 0.000350163
EOD
$published_0_0 << EOD
EOD
$all_0_0 << EOD
0.730273 0.000350163
0.152266 0.000350163
0.0379701 0.000350163
0.0166915 0.000350163
0.131764 0.0336019
0.0262799 0.0336019
0.00682126 0.0336019
0.00302494 0.0336019
0.218779 0.00985221
0.0443701 0.00985221
0.0115267 0.00985221
0.0049398 0.00985221
0.386591 0.00236583
0.0777486 0.00236583
0.0202153 0.00236583
0.00876368 0.00236583
EOD
$all_0_1 << EOD
62.3417 1.5107
21.6611 1.51393
12.5363 1.49998
9.53719 1.49931
1.93439 0.0201631
0.505541 0.0201393
0.184405 0.0208949
0.104079 0.0207389
4.97062 0.0801626
1.15583 0.0798979
0.523666 0.0790832
0.306268 0.0817491
11.6735 0.3817
3.82923 0.3791
1.90777 0.381517
1.28623 0.382304
EOD
$best_0_0 << EOD
0.00302494 0.0336019
0.0049398 0.00985221
0.00876368 0.00236583
0.0166915 0.000350163
0.152266 0.000350163
EOD
$best_0_1 << EOD
0.104079 0.0207389
0.505541 0.0201393
EOD
set title 'Heavy elastica' noenhanced
plot $front_0_0 with lines lw 9 lc rgb '#d0d0d0' title 'best of all', \
  $all_0_0 with points pt 7 ps 0.5 lc rgb '#000000' notitle, \
  $all_0_1 with points pt 7 ps 0.5 lc rgb '#d55e00' notitle, \
  $best_0_0 with lines lw 1.6 lc rgb '#000000' dt 1 title 'vertex' noenhanced, \
  $best_0_1 with lines lw 1.6 lc rgb '#d55e00' dt 1 title 'grid' noenhanced
