set terminal pngcairo size 640,560 font 'DejaVu Sans,11'
set output 'work_precision_cloth_flag.png'
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
0.0163 0.0469816
0.01868 0.0255291
0.02668 0.0217445
0.03791 0.0210697
0.06388 0.0209696
0.09034 0.0107757
0.1115 0.00290013
0.1622 0.000726828
0.255 0.000228179
EOD
$published_0_0 << EOD
0.1074 0.0563429
0.02303 0.0608196
EOD
$all_0_0 << EOD
0.255 0.000228179
0.1622 0.000726828
0.1115 0.00290013
0.09034 0.0107757
0.07367 0.0371326
0.06388 0.0209696
0.03791 0.0210697
0.02668 0.0217445
0.01868 0.0255291
0.0163 0.0469816
EOD
$all_0_1 << EOD
0.2268 0.0158225
0.1452 0.030309
0.1074 0.0563429
0.08875 0.0997791
0.129 0.164523
0.06024 0.0272559
0.03487 0.0379206
0.02303 0.0608196
0.01682 0.10177
0.01662 0.164894
EOD
$all_0_2 << EOD
0.787 0.0784579
0.6528 0.0921478
0.6289 0.142161
0.5985 0.161799
0.645 0.167121
0.3279 0.124363
0.2251 0.117699
0.1928 0.144802
0.1621 0.273852
0.1695 0.32127
EOD
$best_0_0 << EOD
0.0163 0.0469816
0.01868 0.0255291
0.02668 0.0217445
0.03791 0.0210697
0.06388 0.0209696
0.09034 0.0107757
0.1115 0.00290013
0.1622 0.000726828
0.255 0.000228179
EOD
$best_0_1 << EOD
0.01662 0.164894
0.01682 0.10177
0.02303 0.0608196
0.03487 0.0379206
0.06024 0.0272559
0.2268 0.0158225
EOD
$best_0_2 << EOD
0.1621 0.273852
0.1928 0.144802
0.2251 0.117699
0.6528 0.0921478
0.787 0.0784579
EOD
set title 'Strip of cloth let go' noenhanced
plot $front_0_0 with lines lw 9 lc rgb '#d0d0d0' title 'best of all', \
  $all_0_0 with points pt 7 ps 0.5 lc rgb '#000000' notitle, \
  $all_0_1 with points pt 7 ps 0.5 lc rgb '#d55e00' notitle, \
  $all_0_2 with points pt 7 ps 0.5 lc rgb '#0072b2' notitle, \
  $best_0_0 with lines lw 1.6 lc rgb '#000000' dt 1 title 'second order' noenhanced, \
  $best_0_1 with lines lw 1.6 lc rgb '#d55e00' dt 1 title 'backward Euler' noenhanced, \
  $best_0_2 with lines lw 1.6 lc rgb '#0072b2' dt 1 title 'grid' noenhanced, \
  $published_0_0 with points pt 6 ps 2.4 lw 2 lc rgb '#000000' title 'published scheme'
