set terminal pngcairo size 640,560 font 'DejaVu Sans,11'
set output 'work_precision_splash_yarn_half.png'
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
1.658 0.201501
1.963 0.167213
2.569 0.117143
2.754 0.0662093
4.177 0.0338914
7.114 0.0256905
EOD
$published_0_0 << EOD
2.569 0.117143
EOD
$all_0_0 << EOD
7.114 0.0256905
4.177 0.0338914
2.754 0.0662093
1.963 0.167213
EOD
$all_0_1 << EOD
6.865 0.0467079
3.869 0.0733339
2.569 0.117143
1.658 0.201501
EOD
$best_0_0 << EOD
1.963 0.167213
2.754 0.0662093
4.177 0.0338914
7.114 0.0256905
EOD
$best_0_1 << EOD
1.658 0.201501
2.569 0.117143
3.869 0.0733339
6.865 0.0467079
EOD
set title 'Water ball on woven yarns (half)' noenhanced
plot $front_0_0 with lines lw 9 lc rgb '#d0d0d0' title 'best of all', \
  $all_0_0 with points pt 7 ps 0.5 lc rgb '#000000' notitle, \
  $all_0_1 with points pt 7 ps 0.5 lc rgb '#d55e00' notitle, \
  $best_0_0 with lines lw 1.6 lc rgb '#000000' dt 1 title 'second order' noenhanced, \
  $best_0_1 with lines lw 1.6 lc rgb '#d55e00' dt 1 title 'backward Euler' noenhanced, \
  $published_0_0 with points pt 6 ps 2.4 lw 2 lc rgb '#000000' title 'published scheme'
