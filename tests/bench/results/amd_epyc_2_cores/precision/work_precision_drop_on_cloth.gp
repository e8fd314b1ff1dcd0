set terminal pngcairo size 640,560 font 'DejaVu Sans,11'
set output 'work_precision_drop_on_cloth.png'
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
0.04173 0.497312
0.06328 0.373308
0.1083 0.351188
0.118 0.326986
0.123 0.312375
0.1689 0.192247
0.2665 0.114055
0.2827 0.0750578
0.5087 0.0316897
0.9053 0.0309297
0.9375 0.0158237
EOD
$published_0_0 << EOD
0.2665 0.114055
0.118 0.326986
EOD
$all_0_0 << EOD
0.9375 0.0158237
0.5087 0.0316897
0.2827 0.0750578
0.1729 0.195789
0.1632 0.825661
0.4257 0.280753
0.2116 0.292452
0.123 0.312375
0.06519 0.389125
0.04417 0.746182
EOD
$all_0_1 << EOD
0.9053 0.0309297
0.5114 0.0595065
0.2665 0.114055
0.1689 0.192247
0.1083 0.351188
0.4296 0.289022
0.2253 0.304094
0.118 0.326986
0.06328 0.373308
0.04173 0.497312
EOD
$all_0_2 << EOD
1.912 0.459386
1.18 0.474971
0.7784 0.479383
0.6704 0.458803
0.6102 0.448761
0.8901 1.06096
0.5722 1.08391
0.3307 1.09646
0.2617 1.09287
0.2467 1.07068
EOD
$best_0_0 << EOD
0.04417 0.746182
0.06519 0.389125
0.123 0.312375
0.1729 0.195789
0.2827 0.0750578
0.5087 0.0316897
0.9375 0.0158237
EOD
$best_0_1 << EOD
0.04173 0.497312
0.06328 0.373308
0.1083 0.351188
0.118 0.326986
0.1689 0.192247
0.2665 0.114055
0.5114 0.0595065
0.9053 0.0309297
EOD
$best_0_2 << EOD
0.2467 1.07068
0.6102 0.448761
EOD
set title 'A drop meets held cloth' noenhanced
plot $front_0_0 with lines lw 9 lc rgb '#d0d0d0' title 'best of all', \
  $all_0_0 with points pt 7 ps 0.5 lc rgb '#000000' notitle, \
  $all_0_1 with points pt 7 ps 0.5 lc rgb '#d55e00' notitle, \
  $all_0_2 with points pt 7 ps 0.5 lc rgb '#0072b2' notitle, \
  $best_0_0 with lines lw 1.6 lc rgb '#000000' dt 1 title 'second order' noenhanced, \
  $best_0_1 with lines lw 1.6 lc rgb '#d55e00' dt 1 title 'backward Euler' noenhanced, \
  $best_0_2 with lines lw 1.6 lc rgb '#0072b2' dt 1 title 'grid' noenhanced, \
  $published_0_0 with points pt 6 ps 2.4 lw 2 lc rgb '#000000' title 'published scheme'
