carrystep_tang_nano_20k_top.v
carrystep_clock.v
../core/carrystep_uart.v
../core/carrystep_link.v
../core/carrystep_engine.v
