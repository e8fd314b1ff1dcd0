set terminal pngcairo size 640,560 font 'DejaVu Sans,11'
set output 'work_precision_drop_on_yarns.png'
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
0.01757 0.267158
0.02716 0.24045
0.02911 0.165787
0.04407 0.123
0.0833 0.0540666
0.1563 0.0290607
0.2952 0.0202628
EOD
$published_0_0 << EOD
0.0811 0.171326
0.05802 0.248611
EOD
$all_0_0 << EOD
0.2952 0.0202628
0.1563 0.0290607
0.0833 0.0540666
0.04407 0.123
0.02716 0.24045
0.2008 0.126623
0.1041 0.130186
0.06991 0.132454
0.02911 0.165787
0.01757 0.267158
EOD
$all_0_1 << EOD
0.2829 0.0550079
0.1475 0.0980179
0.0811 0.171326
0.04667 0.289144
0.02771 0.420314
0.2031 0.153724
0.1105 0.187464
0.05802 0.248611
0.03613 0.346191
0.01823 0.457544
EOD
$all_0_2 << EOD
0.6936 0.272811
0.4228 0.252881
0.2549 0.261793
0.1778 0.32763
0.1759 0.370539
0.4042 0.273415
0.271 0.268857
0.1337 0.294373
0.08252 0.406189
0.07557 0.479831
EOD
$best_0_0 << EOD
0.01757 0.267158
0.02716 0.24045
0.02911 0.165787
0.04407 0.123
0.0833 0.0540666
0.1563 0.0290607
0.2952 0.0202628
EOD
$best_0_1 << EOD
0.01823 0.457544
0.02771 0.420314
0.03613 0.346191
0.04667 0.289144
0.05802 0.248611
0.0811 0.171326
0.1475 0.0980179
0.2829 0.0550079
EOD
$best_0_2 << EOD
0.07557 0.479831
0.08252 0.406189
0.1337 0.294373
0.2549 0.261793
0.4228 0.252881
EOD
set title 'A drop meets yarns' noenhanced
plot $front_0_0 with lines lw 9 lc rgb '#d0d0d0' title 'best of all', \
  $all_0_0 with points pt 7 ps 0.5 lc rgb '#000000' notitle, \
  $all_0_1 with points pt 7 ps 0.5 lc rgb '#d55e00' notitle, \
  $all_0_2 with points pt 7 ps 0.5 lc rgb '#0072b2' notitle, \
  $best_0_0 with lines lw 1.6 lc rgb '#000000' dt 1 title 'second order' noenhanced, \
  $best_0_1 with lines lw 1.6 lc rgb '#d55e00' dt 1 title 'backward Euler' noenhanced, \
  $best_0_2 with lines lw 1.6 lc rgb '#0072b2' dt 1 title 'grid' noenhanced, \
  $published_0_0 with points pt 6 ps 2.4 lw 2 lc rgb '#000000' title 'published scheme'
